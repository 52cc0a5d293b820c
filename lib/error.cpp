#include "error.hpp"

#include <cstdarg>
#include <cstdio>

namespace pong
{

std::string sentence(const char *text, ...)
{
	char buffer[sizeof(pong_error::text)];
	va_list arguments;
	va_start(arguments, text);
	vsnprintf(buffer, sizeof buffer, text, arguments);
	va_end(arguments);
	return buffer;
}

void set_error(pong_error *error, const char *text)
{
	if (error)
		snprintf(error->text, sizeof error->text, "%s", text);
}

} // namespace pong

const char *pong_version(void)
{
	return PONG_VERSION;
}
