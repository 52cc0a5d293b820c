// What the clocks of a program under test show when the emulated time is zero.
#pragma once

#define EMULATED_EPOCH_NS 1700000000000000000LL
// Far in the machine's past: timers that the program sets by it expire at once, and it looks at its clock again.
#define EMULATED_BOOT_NS 1000000000LL
