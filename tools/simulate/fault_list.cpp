#include "fault_list.hpp"

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "program.hpp"

namespace sim
{

namespace
{

using gige::Fault;
using gige::FaultKind;

struct Kind {
	const char *name;
	FaultKind kind;
	bool has_amount; // that must be given
	double min, max;
};

constexpr Kind kinds[] = {
	{"lose", FaultKind::lose, true, 0, 1},
	{"reorder", FaultKind::reorder, true, 0, 1},
	{"miss", FaultKind::miss, false, 0, 1},
	{"truncate", FaultKind::truncate, false, 0, 1},
	{"freeze", FaultKind::freeze, false, 1, 1},
	{"die", FaultKind::die, false, 1, 1},
	{"offset", FaultKind::offset, true, -1000, 1000},
	{"drift", FaultKind::drift, true, -1000, 1000},
	{"held", FaultKind::held, false, 1, 1},
	{"block", FaultKind::block, true, 1, 65535},
	{"miscount", FaultKind::miscount, false, 1, 1},
};

// Reads one fault, part by part.
class Reader
{
public:
	Reader(const std::string &text, const World &world) : text_(text), world_(world)
	{
	}

	// Which cameras it is of.
	std::array<bool, 2> cameras()
	{
		const std::string word = until(":");
		if (word != "left" && word != "right" && word != "both")
			fail("it begins with left:, right: or both:");
		place_++; // the colon
		return {word != "right", word != "left"};
	}

	Fault fault()
	{
		const Kind &kind = named(until("=@"));
		Fault fault = {kind.kind};
		if (skip('='))
			fault.amount = number(until("@"));
		else if (kind.has_amount)
			fail(std::string(kind.name) + " needs an amount, as in " + kind.name + "=1");
		if (!(fault.amount >= kind.min && fault.amount <= kind.max))
			fail(pong::format("%s lies between %g and %g", kind.name, kind.min, kind.max));
		if (skip('@'))
			fault.begin = moment(until("+"));
		if (skip('+'))
			fault.end = fault.begin + number(until(""));
		return fault;
	}

private:
	[[noreturn]] void fail(const std::string &why) const
	{
		throw pong::UsageError("--fault " + text_ + ": " + why);
	}

	std::string until(const char *marks)
	{
		const size_t begin = place_;
		place_ = *marks ? std::min(text_.find_first_of(marks, begin), text_.size()) : text_.size();
		return text_.substr(begin, place_ - begin);
	}

	bool skip(char mark)
	{
		const bool is_there = place_ < text_.size() && text_[place_] == mark;
		place_ += is_there;
		return is_there;
	}

	const Kind &named(const std::string &name) const
	{
		std::string all;
		for (const Kind &kind : kinds) {
			if (name == kind.name)
				return kind;
			all += (all.empty() ? "" : ", ") + std::string(kind.name);
		}
		fail("there is no fault '" + name + "', but " + all);
	}

	double number(const std::string &word) const
	{
		char *end;
		const double value = strtod(word.c_str(), &end);
		if (word.empty() || *end || !std::isfinite(value))
			fail("'" + word + "' is no number");
		return value;
	}

	double moment(const std::string &word) const
	{
		const bool flight = word.rfind("flight", 0) == 0, bounce = word.rfind("bounce", 0) == 0;
		if (!flight && !bounce)
			return number(word);
		const double count = number(word.substr(6));
		if (!(count >= 1 && count <= 1000))
			fail("flights are counted from 1 to 1000");
		return world_.towards_bounce(static_cast<int>(count), bounce ? 1 : 0.5);
	}

	const std::string &text_;
	const World &world_;
	size_t place_ = 0;
};

} // namespace

std::array<std::vector<Fault>, 2> parse_faults(const std::string &list, const World &world)
{
	std::array<std::vector<Fault>, 2> faults;
	std::istringstream words(list);
	for (std::string word; std::getline(words, word, ',');) {
		Reader reader(word, world);
		const std::array<bool, 2> cameras = reader.cameras();
		const Fault fault = reader.fault();
		for (size_t side = 0; side < 2; side++)
			if (cameras[side])
				faults[side].push_back(fault);
	}
	return faults;
}

} // namespace sim
