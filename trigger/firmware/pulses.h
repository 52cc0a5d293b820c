/* The pulses: three outputs, and the clock that they are made with. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "../protocol.h"

/* Outputs: left camera OC1A (PB5, Arduino's pin 9), right camera OC1B (PB6, pin 10), light OC3A (PC6, pin 5).
 * Start input: ICP1 (PD4, pin 4), pulled up. */
void pulses_init(void);

/* False where the settings cannot be, or pulses are being made. */
bool pulses_set(const struct pong_trigger_settings *settings);

/* False where there are no settings, or pulses are being made. */
bool pulses_start(uint8_t how);

/* Every output inactive. */
void pulses_stop(void);

/* Also tells that the host lives. */
void pulses_status(struct pong_trigger_status *status);

/* Stops where the host has been silent for too long. */
void pulses_guard(void);

/* Takes the oldest pulse not reported yet; false where there is none. */
bool pulses_report(struct pong_trigger_pulse *pulse);
