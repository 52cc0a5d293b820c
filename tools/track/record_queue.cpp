#include "record_queue.hpp"

namespace track
{

RecordQueue::RecordQueue(size_t bytes, size_t records, Mode mode)
	: bytes_(bytes), entries_(records), mode_(mode), due_(mode == Mode::PASS ? UINT64_MAX : 0)
{
}

RecordQueue::Entry &RecordQueue::entry(uint64_t number)
{
	return entries_[number % entries_.size()];
}

bool RecordQueue::has_entries() const
{
	return first_ != next_;
}

// Whether the oldest record is held back: then nobody reads it.
bool RecordQueue::held() const
{
	return has_entries() && first_ >= due_;
}

void RecordQueue::forget_oldest()
{
	first_++;
}

// Records lie one behind the other; one that does not fit before the end of the memory begins at its front.
bool RecordQueue::find_room(size_t size)
{
	if (next_ - first_ == entries_.size())
		return false;
	const size_t oldest = has_entries() ? entry(first_).begin : 0;
	if (!has_entries())
		end_ = 0;
	const bool wrapped = has_entries() && end_ <= oldest;
	const size_t limit = wrapped ? oldest : bytes_.size();
	if (size <= limit - end_)
		reserved_begin_ = end_;
	else if (!wrapped && size <= oldest)
		reserved_begin_ = 0;
	else
		return false;
	reserved_size_ = size;
	return true;
}

bool RecordQueue::make_room(size_t size)
{
	while (!find_room(size)) {
		if (!held())
			return false;
		forget_oldest();
	}
	return true;
}

uint8_t *RecordQueue::reserve(size_t size)
{
	const std::lock_guard<std::mutex> lock(mutex_);
	return !given_up_ && make_room(size) ? bytes_.data() + reserved_begin_ : nullptr;
}

uint8_t *RecordQueue::reserve_patiently(size_t size)
{
	std::unique_lock<std::mutex> lock(mutex_);
	if (size > bytes_.size())
		return nullptr;
	emptied_.wait(lock, [&] { return given_up_ || make_room(size); });
	return given_up_ ? nullptr : bytes_.data() + reserved_begin_;
}

void RecordQueue::commit(const char *channel, int64_t utime)
{
	{
		const std::lock_guard<std::mutex> lock(mutex_);
		end_ = reserved_begin_ + reserved_size_;
		entry(next_++) = {channel, utime, reserved_begin_, reserved_size_};
	}
	filled_.notify_one();
}

void RecordQueue::forget_before(int64_t utime)
{
	const std::lock_guard<std::mutex> lock(mutex_);
	while (held() && entry(first_).utime < utime)
		forget_oldest();
}

void RecordQueue::release()
{
	{
		const std::lock_guard<std::mutex> lock(mutex_);
		if (mode_ == Mode::HOLD_BACK)
			due_ = next_;
	}
	filled_.notify_one();
}

void RecordQueue::close()
{
	{
		const std::lock_guard<std::mutex> lock(mutex_);
		closed_ = true;
	}
	filled_.notify_one();
}

bool RecordQueue::take(Record &record)
{
	std::unique_lock<std::mutex> lock(mutex_);
	filled_.wait(lock, [this] { return (has_entries() && !held()) || closed_; });
	if (!has_entries() || held())
		return false;
	const Entry &oldest = entry(first_);
	record = {oldest.channel, oldest.utime, bytes_.data() + oldest.begin, oldest.size, first_ + 1 == due_};
	return true;
}

void RecordQueue::drop()
{
	{
		const std::lock_guard<std::mutex> lock(mutex_);
		forget_oldest();
	}
	emptied_.notify_one();
}

void RecordQueue::give_up()
{
	{
		const std::lock_guard<std::mutex> lock(mutex_);
		given_up_ = true;
	}
	emptied_.notify_one();
}

} // namespace track
