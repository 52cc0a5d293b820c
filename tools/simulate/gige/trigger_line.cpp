#include "trigger_line.hpp"

#include <algorithm>
#include <cmath>

namespace gige
{

int64_t Schedule::time(int64_t k) const
{
	return origin + std::llround(static_cast<double>(k) * 1e9 / rate);
}

int64_t Schedule::first_from(int64_t when) const
{
	int64_t k = nearest(when);
	while (time(k) < when)
		k++;
	return k;
}

int64_t Schedule::nearest(int64_t when) const
{
	return std::max<int64_t>(0, std::llround(static_cast<double>(when - origin) * rate / 1e9));
}

TriggerLine::TriggerLine(double rate, int64_t power_on) : power_on_(power_on), schedule_{power_on, rate}
{
}

void TriggerLine::end_at(int64_t number)
{
	const std::lock_guard<std::mutex> lock(mutex_);
	last_ = number;
}

void TriggerLine::connect_outside()
{
	const std::lock_guard<std::mutex> lock(mutex_);
	is_outside_ = running_ = true;
}

void TriggerLine::add_edge(int64_t time)
{
	const std::lock_guard<std::mutex> lock(mutex_);
	edge_count_++;
	edges_[static_cast<size_t>(edge_count_ % recent)] = time;
}

void TriggerLine::start(int64_t origin)
{
	const std::lock_guard<std::mutex> lock(mutex_);
	schedule_.origin = origin;
	first_ = next_;
	running_ = true;
}

void TriggerLine::stop()
{
	const std::lock_guard<std::mutex> lock(mutex_);
	running_ = false;
}

bool TriggerLine::is_running() const
{
	const std::lock_guard<std::mutex> lock(mutex_);
	return running_;
}

bool TriggerLine::exists(int64_t number) const
{
	const bool has_come = number > edge_count_ - recent && number <= edge_count_;
	return running_ && (last_ == 0 || number <= last_) && (has_come || !is_outside_);
}

int64_t TriggerLine::time_of(int64_t number) const
{
	if (is_outside_)
		return edges_[static_cast<size_t>(number % recent)];
	return schedule_.time(number - first_);
}

std::optional<Pulse> TriggerLine::next(int64_t earliest) const
{
	const std::lock_guard<std::mutex> lock(mutex_);
	int64_t number = first_ + schedule_.first_from(earliest);
	if (is_outside_)
		for (number = std::max<int64_t>(1, edge_count_ - recent + 1); exists(number); number++)
			if (time_of(number) >= earliest)
				break;
	if (!exists(number))
		return std::nullopt;
	return Pulse{number, time_of(number)};
}

std::optional<int64_t> TriggerLine::next_time() const
{
	const std::lock_guard<std::mutex> lock(mutex_);
	if (!exists(next_))
		return std::nullopt;
	return time_of(next_);
}

std::optional<Pulse> TriggerLine::take(int64_t now)
{
	const std::lock_guard<std::mutex> lock(mutex_);
	if (!exists(next_) || time_of(next_) > now)
		return std::nullopt;
	const Pulse pulse{next_, time_of(next_)};
	next_++;
	return pulse;
}

bool TriggerLine::has_ended() const
{
	const std::lock_guard<std::mutex> lock(mutex_);
	return last_ > 0 && next_ > last_;
}

int64_t TriggerLine::count() const
{
	const std::lock_guard<std::mutex> lock(mutex_);
	return next_ - 1;
}

int64_t TriggerLine::number_at(int64_t time) const
{
	const std::lock_guard<std::mutex> lock(mutex_);
	if (running_ && !is_outside_)
		return first_ + schedule_.nearest(time);
	return 1 + Schedule{power_on_, schedule_.rate}.nearest(time);
}

} // namespace gige
