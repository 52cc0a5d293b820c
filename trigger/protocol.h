/*
 * What pongeye-trigger and the microcontroller say to each other over USB: the one definition, which both include.
 *
 * The device has a vendor class of its own. Requests go through endpoint 0, with bmRequestType 0x40 (to the device)
 * and 0xC0 (from it); a request that makes no sense, or comes at the wrong time, is answered by a STALL. Pulses are
 * reported through an interrupt endpoint, as an array of struct pong_trigger_pulse.
 *
 * A tick is one cycle of the microcontroller's crystal. Ticks are 32 bits wide and wrap after 268 s. All numbers are
 * little endian, as USB's are, and as every machine is that this runs on.
 */
#pragma once

#include <stdint.h>

#if __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "the trigger's protocol is little endian"
#endif

/* Changes with every change of what is below. PONG_TRIGGER_SETTINGS carries the host's in wValue, and is refused where
 * it is not the firmware's; PONG_TRIGGER_INFO tells the firmware's, and the host refuses what is not its own. */
#define PONG_TRIGGER_VERSION 1

/* The id that pid.codes gives to everybody's tests; the manufacturer's name tells us from the others that use it. */
#define PONG_TRIGGER_USB_VENDOR 0x1209
#define PONG_TRIGGER_USB_PRODUCT 0x0001
#define PONG_TRIGGER_USB_MANUFACTURER "Pongeye"

#define PONG_TRIGGER_PULSE_ENDPOINT 0x81
#define PONG_TRIGGER_PULSES_PER_PACKET 8

#define PONG_TRIGGER_TICKS_PER_SECOND 16000000

/* Between two edges of one output the microcontroller needs time to prepare the second: 50 us. */
#define PONG_TRIGGER_MIN_TICKS 800
/* 2 kHz and 0.1 Hz. */
#define PONG_TRIGGER_MIN_PERIOD 8000
#define PONG_TRIGGER_MAX_PERIOD 160000000
/* From the outside edge (or from the request to start) to the rising edge of pulse 1: 100 us. */
#define PONG_TRIGGER_LEAD 1600
/* A device that runs and hears no PONG_TRIGGER_STATUS for 2 s believes its host dead, and stops. */
#define PONG_TRIGGER_SILENCE 32000000

enum pong_trigger_request {
	PONG_TRIGGER_INFO = 1, /* in: struct pong_trigger_info */
	PONG_TRIGGER_SETTINGS =
		2,              /* out: struct pong_trigger_settings; wValue: PONG_TRIGGER_VERSION; only when at rest */
	PONG_TRIGGER_START = 3, /* wValue: enum pong_trigger_start; only when at rest and with settings */
	PONG_TRIGGER_STOP = 4,  /* outputs go inactive at once */
	PONG_TRIGGER_STATUS = 5, /* in: struct pong_trigger_status */
	PONG_TRIGGER_LABEL = 6, /* out: up to 16 printable characters; wValue: enum pong_trigger_label; kept for ever */
};

enum pong_trigger_start {
	PONG_TRIGGER_START_NOW = 0,
	PONG_TRIGGER_START_ON_EDGE = 1, /* the start input falls */
};

enum pong_trigger_label {
	PONG_TRIGGER_NAME = 0,
	PONG_TRIGGER_SERIAL = 1, /* also the USB serial number, from the next time it is plugged in */
};

enum pong_trigger_state {
	PONG_TRIGGER_RESTING = 0,
	PONG_TRIGGER_ARMED = 1, /* waiting for the outside edge */
	PONG_TRIGGER_RUNNING = 2,
};

#define PONG_TRIGGER_LABEL_LENGTH 16

struct pong_trigger_info {
	uint8_t version;                        /* PONG_TRIGGER_VERSION */
	char name[PONG_TRIGGER_LABEL_LENGTH];   /* filled up with zeros; none after 16 characters */
	char serial[PONG_TRIGGER_LABEL_LENGTH]; /* the same */
} __attribute__((packed));

/* A period is period_ticks + period_fraction / 2^32 ticks: what is left of a tick is carried to the next period, so
 * that the mean is right and each period is wrong by less than a tick. */
struct pong_trigger_settings {
	uint32_t period_ticks;
	uint32_t period_fraction;
	uint32_t width_ticks; /* of the pulse on both camera outputs */
	uint32_t light_ticks; /* of the pulse on the light's output, which rises with the cameras'; 0: no light */
	uint32_t count;       /* pulses, then stop; 0: until stopped */
	uint8_t active_low;   /* the camera outputs rest high and pulse low; the light's always rests low */
} __attribute__((packed));

struct pong_trigger_status {
	uint8_t state;       /* enum pong_trigger_state */
	uint32_t now;        /* tick when the request was read */
	uint32_t pulses;     /* since the start */
	uint32_t unreported; /* pulses since the start that the endpoint's queue had no room for */
} __attribute__((packed));

struct pong_trigger_pulse {
	uint32_t number; /* 1 for the first after a start */
	uint32_t tick;   /* of its leading edge */
} __attribute__((packed));
