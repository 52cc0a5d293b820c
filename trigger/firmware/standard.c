#include "standard.h"

#include <avr/io.h>
#include <avr/pgmspace.h>

#include "labels.h"
#include "pulses.h"

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

#define PULSE_SIZE (PONG_TRIGGER_PULSES_PER_PACKET * sizeof(struct pong_trigger_pulse))

_Static_assert(PULSE_SIZE == 64, "UECFG1X of the pulse endpoint says 64 bytes");

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

bool standard_configured(void)
{
	return configuration != 0;
}

void standard_reset(void)
{
	configuration = 0;
	UENUM = CONTROL_EP;
	UECONX = _BV(EPEN);
	UECFG0X = 0;
	UECFG1X = _BV(EPSIZE1) | _BV(EPSIZE0) | _BV(ALLOC); /* 64 bytes */
}

static void reply_string(const char *text, uint8_t length, const struct setup *setup)
{
	uint8_t descriptor[2 + 2 * PONG_TRIGGER_LABEL_LENGTH] = {0, STRING};
	uint8_t i;

	for (i = 0; i < length && text[i]; i++) {
		descriptor[2 + 2 * i] = text[i];
		descriptor[3 + 2 * i] = 0;
	}
	descriptor[0] = 2 + 2 * i;
	control_reply(descriptor, descriptor[0], setup);
}

static void get_string(const struct setup *setup)
{
	static const uint8_t english[] = {4, STRING, 0x09, 0x04};
	char serial[PONG_TRIGGER_LABEL_LENGTH];

	switch (setup->value & 0xff) {
	case LANGUAGES:
		control_reply(english, sizeof english, setup);
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
		control_stall();
	}
}

static void get_descriptor(const struct setup *setup)
{
	uint8_t copy[sizeof configuration_descriptor];

	switch (setup->value >> 8) {
	case DEVICE:
		memcpy_P(copy, device_descriptor, sizeof device_descriptor);
		control_reply(copy, sizeof device_descriptor, setup);
		break;
	case CONFIGURATION:
		memcpy_P(copy, configuration_descriptor, sizeof configuration_descriptor);
		control_reply(copy, sizeof configuration_descriptor, setup);
		break;
	case STRING:
		get_string(setup);
		break;
	default:
		control_stall();
	}
}

/* The address holds from the end of this transfer on. */
static void set_address(const struct setup *setup)
{
	UDADDR = setup->value & 0x7f;
	control_accept();
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
		control_stall();
		return;
	}
	pulses_stop();
	configuration = setup->value;
	if (configuration)
		open_pulse_endpoint();
	control_accept();
}

/* The only feature that can be cleared: the halt of the pulse endpoint, which never halts. Its data toggle begins
 * anew all the same. */
static void clear_halt(void)
{
	UENUM = PULSE_EP;
	UECONX = _BV(RSTDT) | _BV(EPEN);
	UENUM = CONTROL_EP;
	control_accept();
}

void standard_in(const struct setup *setup)
{
	static const uint8_t zeros[2];

	switch (setup->request) {
	case GET_STATUS:
		control_reply(zeros, 2, setup);
		break;
	case GET_DESCRIPTOR:
		get_descriptor(setup);
		break;
	case GET_CONFIGURATION:
		control_reply(&configuration, 1, setup);
		break;
	case GET_INTERFACE:
		control_reply(zeros, 1, setup);
		break;
	default:
		control_stall();
	}
}

/* None of those that we know has data. */
void standard_out(const struct setup *setup)
{
	switch (setup->length ? NO_REQUEST : setup->request) {
	case CLEAR_FEATURE:
		if (setup->type == TO_ENDPOINT && configuration && setup->index == PONG_TRIGGER_PULSE_ENDPOINT)
			clear_halt();
		else
			control_stall();
		break;
	case SET_ADDRESS:
		set_address(setup);
		break;
	case SET_CONFIGURATION:
		set_configuration(setup);
		break;
	case SET_INTERFACE:
		control_accept_or_stall(setup->value == 0 && setup->index == 0);
		break;
	default:
		control_stall();
	}
}
