/*
 * Preloaded into a program under test: its clocks show emulated time, which the file named by PONGEYE_TEST_CLOCK holds
 * in ns, instead of the machine's. So nothing depends on how fast the emulator happens to run.
 */
#define _POSIX_C_SOURCE 200809L
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include "emulated_clock.h"

static const volatile int64_t *elapsed;

__attribute__((constructor)) static void map_clock(void)
{
	const char *path = getenv("PONGEYE_TEST_CLOCK");
	const int file = path ? open(path, O_RDONLY) : -1;

	elapsed = mmap(NULL, sizeof *elapsed, PROT_READ, MAP_SHARED, file, 0);
	if (elapsed == MAP_FAILED)
		abort();
	close(file);
}

int clock_gettime(clockid_t clock, struct timespec *time)
{
	const int64_t now = (clock == CLOCK_REALTIME ? EMULATED_EPOCH_NS : EMULATED_BOOT_NS) + *elapsed;

	time->tv_sec = now / 1000000000;
	time->tv_nsec = now % 1000000000;
	return 0;
}
