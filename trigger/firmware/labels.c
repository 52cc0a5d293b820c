#include "labels.h"

#include <avr/eeprom.h>
#include <string.h>

#define ERASED 0xff

static uint8_t *address_of(uint8_t which)
{
	return (uint8_t *)(uintptr_t)(which * PONG_TRIGGER_LABEL_LENGTH);
}

void label_read(uint8_t which, char text[PONG_TRIGGER_LABEL_LENGTH])
{
	memset(text, 0, PONG_TRIGGER_LABEL_LENGTH);
	if (eeprom_read_byte(address_of(which)) == ERASED)
		strcpy(text, which == PONG_TRIGGER_NAME ? "pongeye" : "1");
	else
		eeprom_read_block(text, address_of(which), PONG_TRIGGER_LABEL_LENGTH);
}

bool label_write(uint8_t which, const char *text, uint8_t length)
{
	char label[PONG_TRIGGER_LABEL_LENGTH] = {0};
	uint8_t i;

	if (which > PONG_TRIGGER_SERIAL || length == 0 || length > PONG_TRIGGER_LABEL_LENGTH)
		return false;
	for (i = 0; i < length; i++)
		if (text[i] < ' ' || text[i] > '~')
			return false;
	memcpy(label, text, length);
	eeprom_update_block(label, address_of(which), sizeof label);
	return true;
}
