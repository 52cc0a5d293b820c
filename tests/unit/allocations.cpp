// Every way to memory leads through these functions, Eigen's and the C library's own too. Sanitizers have replaced them
// already; there, and where the C library is another one, only `new` is counted.
#include "allocations.hpp"

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <new>

static std::atomic<long> count;

long allocations()
{
	return count;
}

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

extern "C" {

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t number, size_t size);
void *__libc_realloc(void *memory, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

void *malloc(size_t size)
{
	count++;
	return __libc_malloc(size);
}

void *calloc(size_t number, size_t size)
{
	count++;
	return __libc_calloc(number, size);
}

void *realloc(void *memory, size_t size)
{
	count++;
	return __libc_realloc(memory, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
	count++;
	return __libc_memalign(alignment, size);
}

int posix_memalign(void **memory, size_t alignment, size_t size)
{
	count++;
	*memory = __libc_memalign(alignment, size);
	return *memory ? 0 : ENOMEM;
}
}

#else

void *operator new(size_t size)
{
	count++;
	if (void *memory = malloc(size))
		return memory;
	throw std::bad_alloc();
}

void *operator new(size_t size, const std::nothrow_t &) noexcept
{
	count++;
	return malloc(size);
}

void operator delete(void *memory) noexcept
{
	free(memory);
}

void operator delete(void *memory, size_t) noexcept
{
	free(memory);
}

#endif
