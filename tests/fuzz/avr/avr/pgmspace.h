/* A host has one memory. */
#pragma once

#include <string.h>

#define PROGMEM
#define memcpy_P memcpy
