#include "rig_watch.hpp"

#include <algorithm>

#include "program.hpp"

namespace track
{

namespace
{

constexpr size_t LEAST_BALLS = 6;         // of a flight, or it may be no ball
constexpr size_t LEAST_FLIGHTS = 6;       // before anything is said
constexpr double LEAST_SCATTER = 0.05;    // of flights, px: a few that agree by chance prove nothing
constexpr double SIGNIFICANT = 5;         // standard deviations
constexpr double HARMLESS = 0.25;         // px: a good calibration may be off by as much
constexpr double MAD_TO_SIGMA = 1.4826;   // of a Gaussian: the median distance from the median, over sigma
constexpr double MEDIAN_TO_MEAN = 1.2533; // of a Gaussian: the median scatters by as much more than the mean

template<size_t CAPACITY> double median(std::array<double, CAPACITY> values, size_t count)
{
	const auto middle = values.begin() + static_cast<std::ptrdiff_t>(count / 2);
	std::nth_element(values.begin(), middle, values.begin() + static_cast<std::ptrdiff_t>(count));
	return *middle;
}

} // namespace

void RigWatch::see(const pong_ball &ball)
{
	if (ball.track != track_)
		close_flight();
	track_ = ball.track;
	if (ball_count_ < BALLS)
		balls_[ball_count_++] = ball.epipolar_distance;
}

void RigWatch::close_flight()
{
	if (ball_count_ >= LEAST_BALLS) {
		flights_[flight_count_++ % FLIGHTS] = median(balls_, ball_count_);
		judge();
	}
	ball_count_ = 0;
}

void RigWatch::judge()
{
	const size_t count = std::min(flight_count_, FLIGHTS);
	if (count < LEAST_FLIGHTS)
		return;
	offset_.mean = median(flights_, count);
	auto distances = flights_;
	for (double &distance : distances)
		distance = std::abs(distance - offset_.mean);
	const double scatter = std::max(MAD_TO_SIGMA * median(distances, count), LEAST_SCATTER);
	offset_.sigma = MEDIAN_TO_MEAN * scatter / std::sqrt(static_cast<double>(count));
	offset_.knocked = std::abs(offset_.mean) > std::max(SIGNIFICANT * offset_.sigma, HARMLESS);
}

std::string RigWatch::warning()
{
	if (!offset_.knocked || said_)
		return "";
	said_ = true;
	return pong::format(
		"the rig was knocked: by the last flights' balls the right picture lies %.2f px (+- %.2f) %s where "
		"the calibration has it; pongeye-calibrate --refine-from corrects it from a table of --output",
		std::abs(offset_.mean), offset_.sigma, offset_.mean > 0 ? "below" : "above");
}

} // namespace track
