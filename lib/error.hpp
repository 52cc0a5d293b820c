// How the world's faults travel: thrown as a Fault inside of the library, turned into a code and a sentence at its
// edge.
#pragma once

#include <new>
#include <string>

#include "pongeye.h"

namespace pong
{

struct Fault {
	int code; // PONG_ERROR_...
	std::string text;
};

std::string sentence(const char *text, ...) __attribute__((format(printf, 1, 2)));

// Write the sentence, cut to fit, where the caller wants one.
void set_error(pong_error *error, const char *text);

// Run `body`, which returns a code of its own; a Fault becomes its code and sentence.
template<class Body> int guarded(pong_error *error, Body body)
{
	try {
		return body();
	} catch (const Fault &fault) {
		set_error(error, fault.text.c_str());
		return fault.code;
	} catch (const std::bad_alloc &) {
		set_error(error, "out of memory");
		return PONG_ERROR_MEMORY;
	}
}

// The same for what makes an object: NULL on a fault.
template<class Make> auto guarded_new(pong_error *error, Make make) -> decltype(make())
{
	decltype(make()) object = nullptr;
	guarded(error, [&] {
		object = make();
		return PONG_FOUND;
	});
	return object;
}

} // namespace pong
