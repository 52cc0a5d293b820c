#include "truth.hpp"

#include <cmath>

#include "renderer.hpp"

namespace sim
{

namespace
{

const char columns[] = "utime frame flight x y z vx vy vz wx wy wz left_u left_v right_u right_v seen_left seen_right "
		       "hit_utime hit_x hit_y hit_z";
constexpr int ball_columns = 20; // those after utime and frame
constexpr int hit_columns = 4;

} // namespace

Truth::Truth(const std::string &path, const Rig &rig) : table_(path, columns), rig_(rig)
{
}

void Truth::add(int64_t utime, int64_t frame, const Episode *episode, double time)
{
	table_.add(utime);
	table_.add(frame);
	if (episode && episode->has_ball())
		add_ball(utime, *episode, time);
	else
		table_.add_absent(ball_columns);
	table_.end_row();
}

void Truth::add_ball(int64_t utime, const Episode &episode, double time)
{
	const Ball ball = episode.ball(time);
	table_.add(static_cast<int64_t>(episode.number));
	for (const Eigen::Vector3d &vector : {ball.position, ball.velocity, ball.spin})
		for (const double value : vector)
			table_.add(value);
	for (const Camera &camera : rig_) {
		Eigen::Vector2d uv(NAN, NAN);
		if (!camera.project(ball.position, &uv))
			uv = {NAN, NAN};
		table_.add(uv.x(), 4);
		table_.add(uv.y(), 4);
	}
	for (const Camera &camera : rig_)
		table_.add(static_cast<int64_t>(wholly_seen(camera, ball.position)));
	if (!episode.flight || !episode.flight->hit())
		return table_.add_absent(hit_columns);
	const Hit &hit = *episode.flight->hit();
	table_.add(utime + static_cast<int64_t>(std::llround(1e6 * (episode.begin + hit.time - time))));
	for (const double value : hit.position)
		table_.add(value);
}

// R maps the board frame to the table frame; x y z is the first inner corner.
BoardTruth::BoardTruth(const std::string &path)
	: table_(path, "utime frame pose x y z r11 r12 r13 r21 r22 r23 r31 r32 r33 plane_z")
{
}

void BoardTruth::add(int64_t utime, int64_t frame, const Episode &episode)
{
	table_.add(utime);
	table_.add(frame);
	table_.add(static_cast<int64_t>(episode.number));
	for (const double value : episode.board->origin)
		table_.add(value);
	for (int row = 0; row < 3; row++)
		for (int column = 0; column < 3; column++)
			table_.add(episode.board->R_table_board(row, column), 9);
	table_.add(episode.board->plane_z);
	table_.end_row();
}

} // namespace sim
