/* The requests that every USB device answers (USB 2.0, chapter 9). */
#pragma once

#include <stdbool.h>

#include "../protocol.h"
#include "control.h"

#define PULSE_EP (PONG_TRIGGER_PULSE_ENDPOINT & 0x0f)

void standard_in(const struct setup *setup);
void standard_out(const struct setup *setup);

/* After a reset of the bus. */
void standard_reset(void);

/* Whether the host has configured us, so that the pulse endpoint is open. */
bool standard_configured(void);
