// The public header is C11, and a C program needs nothing else.
#include "pongeye.h"

int pong_settings_size_in_c(void);
int pong_settings_size_in_c(void)
{
	pong_settings settings;
	pong_settings_defaults(PONG_PAPER, &settings);
	return settings.detect.gap > 0 ? (int)sizeof settings : 0;
}
