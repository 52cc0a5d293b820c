/* Any host on the bus of the trigger's firmware: its requests, taken from the firmware's own sources, with registers
 * that hold what the fuzzer says. An AVR does not stop at a write outside of an array; here it does. */
#include <avr/io.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "../../trigger/firmware/control.c"
#include "../../trigger/firmware/standard.c"
#include "../../trigger/firmware/usb.c"

uint8_t USBCON, UHWCON, PLLFRQ, PLLCSR, UDCON, UENUM, UECONX, UECFG0X, UECFG1X, UERST, UDADDR;

static const uint8_t *bytes;
static size_t left;

static uint8_t next(uint8_t last)
{
	if (left == 0)
		return last;
	left--;
	return *bytes++;
}

/* In the end there is always a new SETUP: that ends every wait. */
uint8_t *bus_flags(void)
{
	static uint8_t flags;
	flags = next(_BV(RXSTPI));
	return &flags;
}

uint8_t *bus_reset(void)
{
	static uint8_t reset;
	reset = next(0) == 0xff ? _BV(EORSTI) : 0; /* seldom */
	return &reset;
}

uint8_t *bus_data(void)
{
	static uint8_t data;
	data = next(0);
	return &data;
}

uint8_t *bus_count(void)
{
	static uint8_t count;
	count = next(0);
	return &count;
}

/* --- What the requests lead to */

bool pulses_set(const struct pong_trigger_settings *settings)
{
	return settings->period_ticks >= PONG_TRIGGER_MIN_PERIOD;
}

bool pulses_start(uint8_t how)
{
	return how <= PONG_TRIGGER_START_ON_EDGE;
}

void pulses_stop(void)
{
}

void pulses_guard(void)
{
}

void pulses_status(struct pong_trigger_status *status)
{
	memset(status, 0, sizeof *status);
}

bool pulses_report(struct pong_trigger_pulse *pulse)
{
	memset(pulse, 0, sizeof *pulse);
	return next(0) & 1;
}

void label_read(uint8_t which, char text[PONG_TRIGGER_LABEL_LENGTH])
{
	memset(text, 'a' + which, PONG_TRIGGER_LABEL_LENGTH); /* without a zero at the end */
}

bool label_write(uint8_t which, const char *text, uint8_t length)
{
	uint8_t i;

	for (i = 0; i < length; i++)
		if (text[i] < ' ' || text[i] > '~')
			return false;
	return which <= PONG_TRIGGER_SERIAL;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	bytes = data;
	left = size;
	standard_reset();
	while (left > 0)
		usb_poll();
	return 0;
}
