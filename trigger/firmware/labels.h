/* The name and the serial number that the device was given, in its EEPROM. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "../protocol.h"

/* Fills up with zeros what is shorter. Never written: "pongeye" and "1". */
void label_read(uint8_t which, char text[PONG_TRIGGER_LABEL_LENGTH]);

/* False where `which` is no label, or a character is not printable. Takes up to 55 ms. */
bool label_write(uint8_t which, const char *text, uint8_t length);
