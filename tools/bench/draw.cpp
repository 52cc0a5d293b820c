// One flight as a picture: what the left camera saw, every third ball of it in one exposure with the centres that were
// found, above a side view of the table with the points and the predictions that were made on the way (the paper's
// Figs. 10 and 12).
#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "commands.hpp"
#include "options.hpp"
#include "owned.hpp"
#include "pongeye.h"
#include "program.hpp"

namespace
{

const int strobe = 3;        // every so many balls one is shown
const double margin = 40;    // px around the side view
const double z_least = -0.3; // m, of the side view
const double z_greatest = 3.8;
const double y_greatest = 0.7;

const cv::Scalar ink(60, 60, 60), table_ink(150, 110, 60), ball_ink(40, 120, 255);

struct Flight {
	pong_rig rig;
	cv::Mat picture; // the left camera's pictures of it, brightest of all
	std::vector<pong_sight> sights;
};

cv::Mat read_picture(const std::string &folder, int frame, const char *side)
{
	const std::string path = pong::format("%s/%06d-%s.png", folder.c_str(), frame, side);
	cv::Mat picture = cv::imread(path, cv::IMREAD_GRAYSCALE);
	if (picture.empty())
		throw pong::Failure(path + " cannot be read");
	return picture;
}

pong_image image_of(const cv::Mat &picture)
{
	return {picture.data, picture.cols, picture.rows, static_cast<ptrdiff_t>(picture.step)};
}

Flight follow(const std::string &folder, int from, int to, pong_profile profile)
{
	Flight flight = {};
	pong_error error;
	pong_settings settings;
	pong_settings_defaults(profile, &settings);
	if (pong_rig_load((folder + "/rig.toml").c_str(), &flight.rig, &error) < 0)
		throw pong::Failure(error.text);
	const pong::OwnedEye eye(pong_eye_new(&flight.rig, &settings, &error));
	if (!eye)
		throw pong::Failure(error.text);
	for (int frame = from; frame <= to; frame++) {
		const cv::Mat left = read_picture(folder, frame, "left"), right = read_picture(folder, frame, "right");
		const pong_image images[2] = {image_of(left), image_of(right)};
		pong_sight sight;
		if (pong_eye_push(eye.get(), std::llround(frame * 1e6 / 110), frame, &images[0], &images[1], &sight,
				  &error) < 0)
			throw pong::Failure(error.text);
		if (flight.picture.empty())
			flight.picture = left.clone();
		if (!sight.has_ball)
			continue;
		if (flight.sights.size() % strobe == 0)
			cv::max(flight.picture, left, flight.picture);
		flight.sights.push_back(sight);
	}
	if (flight.sights.empty())
		throw pong::Failure(pong::format("no ball in frames %d to %d of %s", from, to, folder.c_str()));
	return flight;
}

// From blue, early, to red, late.
cv::Scalar color_of(size_t i, size_t count)
{
	const double late = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0;
	return {230 * (1 - late), 60, 40 + 200 * late};
}

cv::Mat draw_picture(const Flight &flight)
{
	cv::Mat colored, large;
	cv::cvtColor(flight.picture, colored, cv::COLOR_GRAY2BGR);
	cv::resize(colored, large, {}, 2, 2, cv::INTER_CUBIC);
	for (size_t i = 0; i < flight.sights.size(); i += strobe) {
		const pong_centre &centre = flight.sights[i].ball.centre[PONG_LEFT];
		const cv::Point middle(static_cast<int>(std::lround(2 * centre.u)),
				       static_cast<int>(std::lround(2 * centre.v)));
		cv::circle(large, middle, static_cast<int>(std::lround(2 * centre.radius + 3)),
			   color_of(i, flight.sights.size()), 2, cv::LINE_AA);
	}
	return large;
}

// The side view, z to the right and y up.
class SideView
{
public:
	SideView(int width, int height) : canvas_(height, width, CV_8UC3, cv::Scalar(255, 255, 255))
	{
	}

	cv::Point place(double z, double y) const
	{
		const double scale = (canvas_.cols - 2 * margin) / (z_greatest - z_least);
		return {static_cast<int>(std::lround(margin + (z - z_least) * scale)),
			static_cast<int>(std::lround(canvas_.rows - 2 * margin - y * scale))};
	}

	void draw_table(const pong_rig &rig)
	{
		const double net_height = 0.1525;
		cv::line(canvas_, place(0, 0), place(rig.table.length, 0), table_ink, 5, cv::LINE_AA);
		cv::line(canvas_, place(rig.table.length / 2, 0), place(rig.table.length / 2, net_height), table_ink, 2,
			 cv::LINE_AA);
		cv::line(canvas_, place(rig.hit_z, 0), place(rig.hit_z, y_greatest), {170, 170, 170}, 1, cv::LINE_AA);
		write("hit plane", rig.hit_z, y_greatest + 0.03);
		for (int metres = 0; metres <= 3; metres++)
			write(pong::format("%d m", metres), metres, -0.13);
	}

	void write(const std::string &text, double z, double y)
	{
		cv::putText(canvas_, text, place(z, y) - cv::Point(25, 0), cv::FONT_HERSHEY_SIMPLEX, 0.5, ink, 1,
			    cv::LINE_AA);
	}

	void draw_path(const pong_prediction &prediction, const cv::Scalar &color)
	{
		for (int i = 1; i < prediction.path_count; i++) {
			const double *a = prediction.path[i - 1].position, *b = prediction.path[i].position;
			cv::line(canvas_, place(a[2], a[1]), place(b[2], b[1]), color, 1, cv::LINE_AA);
		}
	}

	void draw_ball(const pong_ball &ball)
	{
		cv::circle(canvas_, place(ball.position[2], ball.position[1]), 4, ball_ink, cv::FILLED, cv::LINE_AA);
	}

	const cv::Mat &canvas() const
	{
		return canvas_;
	}

private:
	cv::Mat canvas_;
};

cv::Mat draw_side(const Flight &flight, int width)
{
	SideView view(width, 420);
	view.draw_table(flight.rig);
	for (size_t i = 2; i < flight.sights.size(); i += strobe)
		if (flight.sights[i].has_prediction)
			view.draw_path(flight.sights[i].prediction, color_of(i, flight.sights.size()));
	for (const pong_sight &sight : flight.sights)
		view.draw_ball(sight.ball);
	return view.canvas();
}

} // namespace

int bench::draw(int argc, char **argv)
{
	std::string images, output;
	int from = 0, to = 0, profile = PONG_BEST;
	pong::Options options("pongeye-bench draw", "Draw one flight: the left camera's picture, and the side view.",
			      "  $ pongeye-simulate --out pictures --flights 1\n"
			      "  $ pongeye-bench draw --images pictures --from 0 --to 90 --output flight.png\n"
			      "  pongeye-bench: flight.png: 52 balls");
	options.text("--images", "DIR", "what pongeye-simulate --out wrote", &images);
	options.integer("--from", "FRAME", "first frame", &from, 0, 999999);
	options.integer("--to", "FRAME", "last frame", &to, 0, 999999);
	options.choice("--profile", {"paper", "best"}, "the method (best)", &profile);
	options.text("--output", "FILE", "the picture to write, PNG", &output);
	if (!options.parse(argc, argv))
		return 0;
	if (images.empty() || output.empty())
		throw pong::UsageError("draw needs --images and --output");
	const Flight flight = follow(images, from, to, static_cast<pong_profile>(profile));
	const cv::Mat top = draw_picture(flight);
	cv::Mat sheet;
	cv::vconcat(top, draw_side(flight, top.cols), sheet);
	if (!cv::imwrite(output, sheet))
		throw pong::Failure(output + " cannot be written");
	pong::say(pong::format("%s: %zu balls", output.c_str(), flight.sights.size()));
	return 0;
}
