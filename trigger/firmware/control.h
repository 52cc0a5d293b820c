/* Control transfers on endpoint 0, one packet of data each. With endpoint 0 selected (UENUM). */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#define CONTROL_EP 0
#define CONTROL_SIZE 64

/* bmRequestType. */
enum { TO_DEVICE = 0x00, TO_INTERFACE = 0x01, TO_ENDPOINT = 0x02, FROM = 0x80, VENDOR = 0x40 };

struct setup {
	uint8_t type;
	uint8_t request;
	uint16_t value;
	uint16_t index;
	uint16_t length;
};

/* Takes the SETUP packet that has come. */
struct setup control_begin(void);

/* Sends data, or as much of them as the host asks for. */
void control_reply(const void *data, uint8_t size, const struct setup *setup);

/* Takes the data of a transfer to the device. False where they are more than `size`, or never came. */
bool control_receive(void *data, uint8_t size, const struct setup *setup);

/* Ends a transfer that has no data, or whose data have come. */
void control_accept(void);

/* Refuses the transfer. */
void control_stall(void);

void control_accept_or_stall(bool good);
