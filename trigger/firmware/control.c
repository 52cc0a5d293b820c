#include "control.h"

#include <avr/io.h>

#include "pulses.h"

struct setup control_begin(void)
{
	struct setup setup;
	uint8_t *bytes = (uint8_t *)&setup, i;

	for (i = 0; i < sizeof setup; i++)
		bytes[i] = UEDATX;
	UEINTX = (uint8_t) ~(_BV(RXSTPI) | _BV(RXOUTI));
	return setup;
}

/* Waits until one of the flags is set. False where the host has given the transfer up: a new SETUP, or a reset. A host
 * that dies in the middle of a transfer must not keep the pulses running. */
static bool control_wait(uint8_t flags)
{
	for (;;) {
		pulses_guard();
		if ((UDINT & _BV(EORSTI)) || (UEINTX & _BV(RXSTPI)))
			return false;
		if (UEINTX & flags)
			return true;
	}
}

/* Unless the host has begun the next transfer meanwhile: the stall would hit that. */
void control_stall(void)
{
	if (!(UEINTX & _BV(RXSTPI)))
		UECONX = _BV(STALLRQ) | _BV(EPEN);
}

void control_accept(void)
{
	if (!control_wait(_BV(TXINI)))
		return;
	UEINTX = (uint8_t)~_BV(TXINI);
	control_wait(_BV(TXINI));
}

void control_accept_or_stall(bool good)
{
	if (good)
		control_accept();
	else
		control_stall();
}

void control_reply(const void *data, uint8_t size, const struct setup *setup)
{
	const uint8_t *bytes = data;
	uint8_t i;

	if (setup->length == 0) { /* then the transfer has no data, whatever its direction says */
		control_accept();
		return;
	}
	if (!control_wait(_BV(TXINI)))
		return;
	if (size > setup->length)
		size = setup->length;
	for (i = 0; i < size; i++)
		UEDATX = bytes[i];
	UEINTX = (uint8_t)~_BV(TXINI);
	if (control_wait(_BV(RXOUTI)))
		UEINTX = (uint8_t)~_BV(RXOUTI);
}

bool control_receive(void *data, uint8_t size, const struct setup *setup)
{
	uint8_t *bytes = data, i;

	if (setup->length > size || !control_wait(_BV(RXOUTI)) || UEBCLX != setup->length)
		return false;
	for (i = 0; i < setup->length; i++)
		bytes[i] = UEDATX;
	UEINTX = (uint8_t)~_BV(RXOUTI);
	return true;
}
