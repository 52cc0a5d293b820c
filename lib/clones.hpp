// Loops that the compiler turns into vector instructions, for what every processor of a kind has; on x86 also for AVX2,
// chosen when the program starts. There is one source for both, so the numbers are the same. With or without clones,
// such a function is not inlined.
#pragma once

#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) &&    \
	(defined(__GNUC__) && !defined(__clang__) || __clang_major__ >= 14)
#define PONG_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define PONG_CLONES __attribute__((noinline))
#endif
