#include "output.hpp"

#include <cmath>

namespace track
{

namespace
{

constexpr char COLUMNS[] = "utime frame left_u left_v right_u right_v x y z vx vy vz sx sy sz "
			   "hit_utime hit_x hit_y hit_z hit_sx hit_sy hit_sz hit_st";
constexpr int BALL_COLUMNS = 13, HIT_COLUMNS = 8;
constexpr int PIXEL_DECIMALS = 3;

} // namespace

Output::Output(const std::string &path) : table_(path, COLUMNS)
{
}

void Output::write(const StereoPair &pair, const pong_sight &sight)
{
	table_.add(pair.utime);
	table_.add(pair.frame);
	if (sight.has_ball)
		add_ball(sight.ball);
	else
		table_.add_absent(BALL_COLUMNS);
	if (sight.has_prediction && sight.prediction.has_hit)
		add_hit(sight.prediction);
	else
		table_.add_absent(HIT_COLUMNS);
	table_.end_row();
}

void Output::add_ball(const pong_ball &ball)
{
	for (const pong_centre &centre : ball.centre) {
		table_.add(centre.u, PIXEL_DECIMALS);
		table_.add(centre.v, PIXEL_DECIMALS);
	}
	for (const double position : ball.position)
		table_.add(position);
	for (const double velocity : ball.velocity)
		table_.add(velocity);
	for (int axis = 0; axis < 3; axis++)
		table_.add(std::sqrt(ball.covariance[axis][axis]));
}

void Output::add_hit(const pong_prediction &prediction)
{
	table_.add(prediction.hit.utime);
	for (const double position : prediction.hit.position)
		table_.add(position);
	for (int i = 0; i < 4; i++)
		table_.add(std::sqrt(prediction.hit_covariance[i][i]));
}

} // namespace track
