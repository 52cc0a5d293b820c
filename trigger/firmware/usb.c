#include "usb.h"

#include <avr/io.h>
#include <avr/pgmspace.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include "labels.h"
#include "pulses.h"

/* USB 2.0, chapter 9. */
enum {
	GET_STATUS = 0,
	CLEAR_FEATURE = 1,
	SET_ADDRESS = 5,
	GET_DESCRIPTOR = 6,
	GET_CONFIGURATION = 8,
	SET_CONFIGURATION = 9,
	GET_INTERFACE = 10,
	SET_INTERFACE = 11,
	NO_REQUEST = 0xff,
};
enum { DEVICE = 1, CONFIGURATION = 2, STRING = 3, INTERFACE = 4, ENDPOINT = 5 };
enum { LANGUAGES, MANUFACTURER, PRODUCT, SERIAL };
enum { TO_DEVICE = 0x00, TO_INTERFACE = 0x01, TO_ENDPOINT = 0x02, FROM = 0x80, VENDOR = 0x40 };

#define CONTROL_SIZE 64 /* every reply and all data of ours fit in one packet */
#define PULSE_SIZE (PONG_TRIGGER_PULSES_PER_PACKET * sizeof(struct pong_trigger_pulse))
#define CONTROL_EP 0
#define PULSE_EP (PONG_TRIGGER_PULSE_ENDPOINT & 0x0f)

_Static_assert(PULSE_SIZE == 64, "UECFG1X of the pulse endpoint says 64 bytes");
_Static_assert(sizeof(struct pong_trigger_info) < CONTROL_SIZE, "a reply is one short packet");

struct setup {
	uint8_t type;
	uint8_t request;
	uint16_t value;
	uint16_t index;
	uint16_t length;
};

// clang-format off
static const uint8_t device_descriptor[] PROGMEM = {
	18, DEVICE, 0x00, 0x02,   /* USB 2.0 */
	0xff, 0, 0, CONTROL_SIZE, /* a class of our own */
	PONG_TRIGGER_USB_VENDOR & 0xff, PONG_TRIGGER_USB_VENDOR >> 8,
	PONG_TRIGGER_USB_PRODUCT & 0xff, PONG_TRIGGER_USB_PRODUCT >> 8,
	PONG_TRIGGER_VERSION, 0,
	MANUFACTURER, PRODUCT, SERIAL, 1,
};

static const uint8_t configuration_descriptor[] PROGMEM = {
	9, CONFIGURATION, 25, 0, 1, 1, 0, 0x80, 50, /* powered by the bus, 100 mA */
	9, INTERFACE, 0, 0, 1, 0xff, 0, 0, 0,
	7, ENDPOINT, PONG_TRIGGER_PULSE_ENDPOINT, 3 /* interrupt */, PULSE_SIZE, 0, 1 /* ms */,
};
// clang-format on

static uint8_t configuration;

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

/* --- Endpoint 0 */

/* Waits until one of the flags is set. False where the host has given the transfer up: a new SETUP, or a reset. A host
 * that dies in the middle of a transfer must not keep the pulses running. */
static bool wait_for(uint8_t flags)
{
	for (;;) {
		pulses_guard();
		if ((UDINT & _BV(EORSTI)) || (UEINTX & _BV(RXSTPI)))
			return false;
		if (UEINTX & flags)
			return true;
	}
}

/* Refuses the transfer, unless the host has begun the next one meanwhile: the stall would hit that. */
static void stall(void)
{
	if (!(UEINTX & _BV(RXSTPI)))
		UECONX = _BV(STALLRQ) | _BV(EPEN);
}

/* Ends a transfer that has no data, or whose data has come. */
static void accept(void)
{
	UEINTX = (uint8_t)~_BV(TXINI);
	wait_for(_BV(TXINI));
}

static void accept_or_stall(bool good)
{
	if (good)
		accept();
	else
		stall();
}

static void reply(const void *data, uint8_t size, const struct setup *setup)
{
	const uint8_t *bytes = data;
	uint8_t i;

	if (setup->length == 0) { /* then the transfer has no data, whatever its direction says */
		accept();
		return;
	}
	if (size > setup->length)
		size = setup->length;
	for (i = 0; i < size; i++)
		UEDATX = bytes[i];
	UEINTX = (uint8_t)~_BV(TXINI);
	if (wait_for(_BV(RXOUTI)))
		UEINTX = (uint8_t)~_BV(RXOUTI);
}

/* The data of a transfer to the device. False where it is more than `size`, or never came. */
static bool receive(void *data, uint8_t size, const struct setup *setup)
{
	uint8_t *bytes = data, i;

	if (setup->length > size || !wait_for(_BV(RXOUTI)) || UEBCLX != setup->length)
		return false;
	for (i = 0; i < setup->length; i++)
		bytes[i] = UEDATX;
	UEINTX = (uint8_t)~_BV(RXOUTI);
	return true;
}

/* --- Chapter 9 */

static void reply_string(const char *text, uint8_t length, const struct setup *setup)
{
	uint8_t descriptor[2 + 2 * PONG_TRIGGER_LABEL_LENGTH] = {0, STRING};
	uint8_t i;

	for (i = 0; i < length && text[i]; i++) {
		descriptor[2 + 2 * i] = text[i];
		descriptor[3 + 2 * i] = 0;
	}
	descriptor[0] = 2 + 2 * i;
	reply(descriptor, descriptor[0], setup);
}

static void get_string(const struct setup *setup)
{
	static const uint8_t english[] = {4, STRING, 0x09, 0x04};
	char serial[PONG_TRIGGER_LABEL_LENGTH];

	switch (setup->value & 0xff) {
	case LANGUAGES:
		reply(english, sizeof english, setup);
		break;
	case MANUFACTURER:
		reply_string(PONG_TRIGGER_USB_MANUFACTURER, sizeof PONG_TRIGGER_USB_MANUFACTURER, setup);
		break;
	case PRODUCT:
		reply_string("Pongeye trigger", sizeof "Pongeye trigger", setup);
		break;
	case SERIAL:
		label_read(PONG_TRIGGER_SERIAL, serial);
		reply_string(serial, sizeof serial, setup);
		break;
	default:
		stall();
	}
}

static void get_descriptor(const struct setup *setup)
{
	uint8_t copy[sizeof configuration_descriptor];

	switch (setup->value >> 8) {
	case DEVICE:
		memcpy_P(copy, device_descriptor, sizeof device_descriptor);
		reply(copy, sizeof device_descriptor, setup);
		break;
	case CONFIGURATION:
		memcpy_P(copy, configuration_descriptor, sizeof configuration_descriptor);
		reply(copy, sizeof configuration_descriptor, setup);
		break;
	case STRING:
		get_string(setup);
		break;
	default:
		stall();
	}
}

/* The address holds from the end of this transfer on. */
static void set_address(const struct setup *setup)
{
	UDADDR = setup->value & 0x7f;
	accept();
	UDADDR = (setup->value & 0x7f) | _BV(ADDEN);
}

static void open_pulse_endpoint(void)
{
	UENUM = PULSE_EP;
	UECONX = _BV(EPEN);
	UECFG0X = _BV(EPTYPE1) | _BV(EPTYPE0) | _BV(EPDIR);              /* interrupt, in */
	UECFG1X = _BV(EPSIZE1) | _BV(EPSIZE0) | _BV(EPBK0) | _BV(ALLOC); /* 64 bytes, twice */
	UERST = _BV(PULSE_EP);
	UERST = 0;
	UENUM = CONTROL_EP;
}

static void set_configuration(const struct setup *setup)
{
	if (setup->value > 1) {
		stall();
		return;
	}
	pulses_stop();
	configuration = setup->value;
	if (configuration)
		open_pulse_endpoint();
	accept();
}

/* The only feature that can be cleared: the halt of the pulse endpoint, which never halts. Its data toggle begins
 * anew all the same. */
static void clear_halt(void)
{
	UENUM = PULSE_EP;
	UECONX = _BV(RSTDT) | _BV(EPEN);
	UENUM = CONTROL_EP;
	accept();
}

static void standard_in(const struct setup *setup)
{
	static const uint8_t zeros[2];

	switch (setup->request) {
	case GET_STATUS:
		reply(zeros, 2, setup);
		break;
	case GET_DESCRIPTOR:
		get_descriptor(setup);
		break;
	case GET_CONFIGURATION:
		reply(&configuration, 1, setup);
		break;
	case GET_INTERFACE:
		reply(zeros, 1, setup);
		break;
	default:
		stall();
	}
}

/* None of those that we know has data. */
static void standard_out(const struct setup *setup)
{
	switch (setup->length ? NO_REQUEST : setup->request) {
	case CLEAR_FEATURE:
		if (setup->type == TO_ENDPOINT && configuration && setup->index == PONG_TRIGGER_PULSE_ENDPOINT)
			clear_halt();
		else
			stall();
		break;
	case SET_ADDRESS:
		set_address(setup);
		break;
	case SET_CONFIGURATION:
		set_configuration(setup);
		break;
	case SET_INTERFACE:
		accept_or_stall(setup->value == 0 && setup->index == 0);
		break;
	default:
		stall();
	}
}

/* --- Our requests */

static void request_out(const struct setup *setup)
{
	struct pong_trigger_settings settings;
	char label[PONG_TRIGGER_LABEL_LENGTH];

	switch (setup->request) {
	case PONG_TRIGGER_SETTINGS:
		accept_or_stall(setup->value == PONG_TRIGGER_VERSION && setup->length == sizeof settings &&
				receive(&settings, sizeof settings, setup) && pulses_set(&settings));
		break;
	case PONG_TRIGGER_START:
		accept_or_stall(configuration && setup->length == 0 && setup->value <= 0xff &&
				pulses_start(setup->value));
		break;
	case PONG_TRIGGER_STOP:
		pulses_stop();
		accept_or_stall(setup->length == 0);
		break;
	case PONG_TRIGGER_LABEL:
		accept_or_stall(setup->length && setup->value <= 0xff && receive(label, sizeof label, setup) &&
				label_write(setup->value, label, setup->length));
		break;
	default:
		stall();
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
		reply(&info, sizeof info, setup);
		break;
	case PONG_TRIGGER_STATUS:
		pulses_status(&status);
		reply(&status, sizeof status, setup);
		break;
	default:
		stall();
	}
}

/* --- The loop */

static void serve_setup(void)
{
	struct setup setup;
	uint8_t *bytes = (uint8_t *)&setup, i;

	for (i = 0; i < sizeof setup; i++)
		bytes[i] = UEDATX;
	UEINTX = (uint8_t) ~(_BV(RXSTPI) | _BV(RXOUTI) | _BV(TXINI));
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
		stall();
	}
}

/* After a reset of the bus the host knows nothing of us, and we make no pulses. */
static void serve_reset(void)
{
	UDINT = (uint8_t)~_BV(EORSTI);
	pulses_stop();
	configuration = 0;
	UENUM = CONTROL_EP;
	UECONX = _BV(EPEN);
	UECFG0X = 0;
	UECFG1X = _BV(EPSIZE1) | _BV(EPSIZE0) | _BV(ALLOC); /* 64 bytes */
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
	if (configuration)
		send_pulses();
}
