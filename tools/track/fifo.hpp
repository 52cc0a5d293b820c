// A queue of bounded length that allocates nothing.
#pragma once

#include <cassert>
#include <cstddef>

namespace track
{

template<class T, size_t CAPACITY> class Fifo
{
public:
	bool empty() const
	{
		return count_ == 0;
	}

	bool full() const
	{
		return count_ == CAPACITY;
	}

	void push(const T &item)
	{
		assert(!full());
		items_[(first_ + count_++) % CAPACITY] = item;
	}

	const T &front() const
	{
		assert(!empty());
		return items_[first_];
	}

	T pop()
	{
		const T item = front();
		first_ = (first_ + 1) % CAPACITY;
		count_--;
		return item;
	}

private:
	T items_[CAPACITY];
	size_t first_ = 0, count_ = 0;
};

} // namespace track
