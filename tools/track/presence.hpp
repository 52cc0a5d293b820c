// Whether a GigE Vision camera is there, and whether somebody controls it: asked by one small datagram, which answers
// in a tenth of a millisecond where Aravis' ways of asking wait for seconds.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace track
{

enum class Presence { ABSENT, FREE, CONTROLLED };

// Of the camera at this IPv4 address (host byte order); asks again and again until `patience` is over.
Presence ask_presence(uint32_t address, std::chrono::milliseconds patience);

// "192.168.1.10"; none where the text is something else.
std::optional<uint32_t> parse_address(const std::string &text);

} // namespace track
