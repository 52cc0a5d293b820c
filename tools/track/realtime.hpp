// What an operating system gives to those who must not be late, where the user may have it.
#pragma once

namespace track
{

// Real-time priority for the calling thread; where the user may not have it, it is said once, and all goes on.
void make_thread_realtime(int priority);

// Keep all memory of the program in RAM, now and later, and take no more of it than needed: before threads are started.
// Where the user may not, nothing is locked.
void lock_memory();

} // namespace track
