// Any bytes as a file that can be opened by name, for readers that take a path. In memory.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>
#include <sys/mman.h>
#include <unistd.h>

class BytesFile
{
public:
	BytesFile(const uint8_t *data, size_t size) : file_(memfd_create("fuzz", 0))
	{
		if (file_ < 0 || write(file_, data, size) != static_cast<ssize_t>(size))
			abort();
	}

	~BytesFile()
	{
		close(file_);
	}

	BytesFile(const BytesFile &) = delete;
	BytesFile &operator=(const BytesFile &) = delete;

	std::string path() const
	{
		return "/proc/self/fd/" + std::to_string(file_);
	}

private:
	int file_;
};
