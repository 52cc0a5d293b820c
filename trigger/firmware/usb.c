#include "usb.h"

#include <avr/io.h>
#include <stdbool.h>

#include "labels.h"
#include "pulses.h"
#include "standard.h"

_Static_assert(sizeof(struct pong_trigger_info) < CONTROL_SIZE, "a reply is one short packet");

void usb_init(void)
{
	USBCON = _BV(FRZCLK); /* off, whatever a bootloader has left */
	UHWCON = _BV(UVREGE);
	USBCON = _BV(USBE) | _BV(FRZCLK);
	PLLFRQ = _BV(PDIV2);  /* 48 MHz */
	PLLCSR = _BV(PINDIV); /* from a crystal of 16 MHz */
	PLLCSR |= _BV(PLLE);
	while (!(PLLCSR & _BV(PLOCK)))
		;
	USBCON = _BV(USBE) | _BV(OTGPADE);
	UDCON = 0; /* attach, at full speed */
}

/* --- Our requests */

static void request_out(const struct setup *setup)
{
	struct pong_trigger_settings settings;
	char label[PONG_TRIGGER_LABEL_LENGTH];

	switch (setup->request) {
	case PONG_TRIGGER_SETTINGS:
		control_accept_or_stall(setup->value == PONG_TRIGGER_VERSION && setup->length == sizeof settings &&
					control_receive(&settings, sizeof settings, setup) && pulses_set(&settings));
		break;
	case PONG_TRIGGER_START:
		control_accept_or_stall(standard_configured() && setup->length == 0 && setup->value <= 0xff &&
					pulses_start(setup->value));
		break;
	case PONG_TRIGGER_STOP:
		pulses_stop();
		control_accept_or_stall(setup->length == 0);
		break;
	case PONG_TRIGGER_LABEL:
		control_accept_or_stall(setup->length && setup->value <= 0xff &&
					control_receive(label, sizeof label, setup) &&
					label_write(setup->value, label, setup->length));
		break;
	default:
		control_stall();
	}
}

static void request_in(const struct setup *setup)
{
	struct pong_trigger_info info = {.version = PONG_TRIGGER_VERSION};
	struct pong_trigger_status status;

	switch (setup->request) {
	case PONG_TRIGGER_INFO:
		label_read(PONG_TRIGGER_NAME, info.name);
		label_read(PONG_TRIGGER_SERIAL, info.serial);
		control_reply(&info, sizeof info, setup);
		break;
	case PONG_TRIGGER_STATUS:
		pulses_status(&status);
		control_reply(&status, sizeof status, setup);
		break;
	default:
		control_stall();
	}
}

/* --- The loop */

static void serve_setup(void)
{
	const struct setup setup = control_begin();

	switch (setup.type) {
	case FROM | TO_DEVICE:
	case FROM | TO_INTERFACE:
	case FROM | TO_ENDPOINT:
		standard_in(&setup);
		break;
	case TO_DEVICE:
	case TO_INTERFACE:
	case TO_ENDPOINT:
		standard_out(&setup);
		break;
	case VENDOR:
		request_out(&setup);
		break;
	case FROM | VENDOR:
		request_in(&setup);
		break;
	default:
		control_stall();
	}
}

/* After a reset of the bus the host knows nothing of us, and we make no pulses. */
static void serve_reset(void)
{
	UDINT = (uint8_t)~_BV(EORSTI);
	pulses_stop();
	standard_reset();
}

/* Writes the pulses that wait into the endpoint, where it has a free bank. */
static void send_pulses(void)
{
	struct pong_trigger_pulse pulse;
	const uint8_t *bytes = (const uint8_t *)&pulse;
	uint8_t pulses = 0, i;

	UENUM = PULSE_EP;
	if (UEINTX & _BV(TXINI)) {
		while (pulses < PONG_TRIGGER_PULSES_PER_PACKET && pulses_report(&pulse)) {
			for (i = 0; i < sizeof pulse; i++)
				UEDATX = bytes[i];
			pulses++;
		}
		if (pulses) {
			UEINTX = (uint8_t)~_BV(TXINI);
			UEINTX = (uint8_t)~_BV(FIFOCON);
		}
	}
	UENUM = CONTROL_EP;
}

void usb_poll(void)
{
	if (UDINT & _BV(EORSTI))
		serve_reset();
	UENUM = CONTROL_EP;
	if (UEINTX & _BV(RXSTPI))
		serve_setup();
	if (standard_configured())
		send_pulses();
}
