#include "registers.hpp"

#include <algorithm>
#include <cmath>

namespace gige
{

namespace
{

bool is_entry(const Register &place, uint32_t value)
{
	return std::any_of(place.entries.begin(), place.entries.end(),
			   [value](const Entry &entry) { return entry.value == value; });
}

bool is_within_limits(const Register &place, double number)
{
	return number >= place.min && number <= place.max; // false for NaN
}

bool accepts(const Register &place, uint32_t value)
{
	switch (place.kind) {
	case Kind::integer:
		return is_within_limits(place, value) && std::fmod(value - place.min, place.step) == 0;
	case Kind::real:
		return is_within_limits(place, number_of(value));
	case Kind::boolean:
		return value <= 1;
	case Kind::enumeration:
		return is_entry(place, value);
	case Kind::command:
		return value == static_cast<uint32_t>(place.max);
	case Kind::text:
		break;
	}
	return false;
}

} // namespace

RegisterFile::RegisterFile(std::vector<Register> table, const std::string &description)
	: table_(std::move(table)),
	  memory_(at::description + (description.size() + 3) / 4 * 4, '\0') // clients read whole words
{
	set_text(at::description, description);
}

const Register *RegisterFile::find(uint32_t address) const
{
	for (const Register &place : table_)
		if (address >= place.address && address - place.address < place.length)
			return &place;
	return nullptr;
}

// What the memory has between the registers reads as zero.
Status RegisterFile::read(uint32_t address, uint32_t *value) const
{
	if (address % 4)
		return Status::bad_alignment;
	if (address >= memory_.size())
		return Status::invalid_address;
	*value = get(address);
	return Status::success;
}

Status RegisterFile::write(uint32_t address, uint32_t value)
{
	if (address % 4)
		return Status::bad_alignment;
	if (address >= memory_.size())
		return Status::invalid_address;
	const Register *place = find(address);
	if (!place || place->access != Access::write)
		return Status::write_protect;
	if (!accepts(*place, value))
		return Status::invalid_parameter;
	set(address, value);
	return Status::success;
}

bool RegisterFile::has(uint32_t address, size_t length) const
{
	return address <= memory_.size() && length <= memory_.size() - address;
}

size_t RegisterFile::description_size() const
{
	return memory_.size() - at::description;
}

Bytes RegisterFile::copy(uint32_t address, size_t length) const
{
	return Bytes(memory_.begin() + address, memory_.begin() + address + static_cast<ptrdiff_t>(length));
}

uint32_t RegisterFile::get(uint32_t address) const
{
	return load32(&memory_[address]);
}

float RegisterFile::get_real(uint32_t address) const
{
	return number_of(get(address));
}

void RegisterFile::set(uint32_t address, uint32_t value)
{
	store32(&memory_[address], value);
}

void RegisterFile::set_real(uint32_t address, float value)
{
	set(address, bits_of(value));
}

void RegisterFile::set64(uint32_t address, uint64_t value)
{
	set(address, static_cast<uint32_t>(value >> 32));
	set(address + 4, static_cast<uint32_t>(value));
}

void RegisterFile::set_text(uint32_t address, const std::string &text)
{
	std::copy(text.begin(), text.end(), memory_.begin() + address);
}

} // namespace gige
