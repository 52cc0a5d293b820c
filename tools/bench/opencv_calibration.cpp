#include "opencv_calibration.hpp"

#include <map>

#include <opencv2/calib3d.hpp>

namespace bench
{

namespace
{

// What cameras saw of one board, in OpenCV's form: the same points for all of them.
struct BoardPoints {
	std::vector<cv::Point3f> place;
	std::vector<cv::Point2f> pixel[2];
};

struct Lens {
	cv::Mat K, D;
};

using Corners = std::vector<pong_corner>;

// Of the points of a view that `wanted` sees: those of one camera, or (-1) those that both see.
BoardPoints points_of(const Corners &corners, int view, int wanted)
{
	std::map<int, const pong_corner *> seen[2];
	for (const pong_corner &corner : corners)
		if (corner.view == view)
			seen[corner.side][corner.point] = &corner;
	BoardPoints points;
	for (const auto &[point, corner] : seen[wanted < 0 ? 0 : wanted]) {
		if (wanted < 0 && !seen[1].count(point))
			continue;
		points.place.emplace_back(corner->board[0], corner->board[1], corner->board[2]);
		for (int side = 0; side < 2; side++)
			if (const auto at = seen[side].find(point); at != seen[side].end())
				points.pixel[side].emplace_back(at->second->uv[0], at->second->uv[1]);
	}
	return points;
}

bool calibrate_lens(const std::vector<pong_view> &views, const Corners &corners, PictureSize size, int side,
		    bool placed, Lens &lens)
{
	std::vector<std::vector<cv::Point3f>> places;
	std::vector<std::vector<cv::Point2f>> pixels;
	for (size_t i = 0; i < views.size(); i++) {
		BoardPoints points = points_of(corners, static_cast<int>(i), side);
		if ((placed && !views[i].placed) || points.place.size() < 6)
			continue;
		places.push_back(points.place);
		pixels.push_back(points.pixel[side]);
	}
	std::vector<cv::Mat> rotations, translations;
	cv::calibrateCamera(places, pixels, {size.width, size.height}, lens.K, lens.D, rotations, translations,
			    cv::CALIB_FIX_K3);
	return cv::checkRange(lens.K) && lens.K.at<double>(0, 0) > 0;
}

// The camera's pose in the table frame from all placed boards as they should stand. Identity where there is none: the
// frame is the camera's own, x left and y up.
bool camera_from_table(const std::vector<pong_view> &views, const Corners &corners, int side, const Lens &lens,
		       cv::Matx33d &R, cv::Vec3d &t)
{
	std::vector<cv::Point3d> places;
	std::vector<cv::Point2d> pixels;
	for (const pong_corner &corner : corners) {
		const pong_view &view = views[static_cast<size_t>(corner.view)];
		if (corner.side != side || !view.placed)
			continue;
		double place[3];
		for (int i = 0; i < 3; i++)
			place[i] = view.pose[i][0] * corner.board[0] + view.pose[i][1] * corner.board[1] +
				   view.pose[i][2] * corner.board[2] + view.pose[i][3];
		places.emplace_back(place[0], place[1], place[2]);
		pixels.emplace_back(corner.uv[0], corner.uv[1]);
	}
	R = cv::Matx33d(-1, 0, 0, 0, -1, 0, 0, 0, 1);
	t = {};
	if (places.empty())
		return true;
	cv::Vec3d turn;
	cv::Rodrigues(R, turn);
	if (!cv::solvePnP(places, pixels, lens.K, lens.D, turn, t))
		return false;
	cv::Rodrigues(turn, R);
	return true;
}

pong_camera camera_of(const Lens &lens, const cv::Matx33d &R, const cv::Vec3d &t, PictureSize size)
{
	pong_camera camera = {};
	camera.width = size.width;
	camera.height = size.height;
	const cv::Matx33d K = lens.K;
	const cv::Matx33d M = K * R;
	const cv::Vec3d shift = K * t;
	for (int i = 0; i < 3; i++) {
		for (int j = 0; j < 3; j++)
			camera.P[i][j] = M(i, j);
		camera.P[i][3] = shift[i];
	}
	for (int i = 0; i < 5; i++)
		camera.distortion[i] = lens.D.at<double>(i);
	return camera;
}

} // namespace

bool calibrate_each(const std::vector<pong_view> &views, const Corners &corners, PictureSize size,
		    pong_camera camera[2])
{
	for (int side = 0; side < 2; side++) {
		Lens lens;
		cv::Matx33d R;
		cv::Vec3d t;
		if (!calibrate_lens(views, corners, size, side, true, lens) ||
		    !camera_from_table(views, corners, side, lens, R, t))
			return false;
		camera[side] = camera_of(lens, R, t, size);
	}
	return true;
}

bool calibrate_stereo(const std::vector<pong_view> &views, const Corners &corners, PictureSize size,
		      pong_camera camera[2])
{
	Lens lens[2];
	for (int side = 0; side < 2; side++)
		if (!calibrate_lens(views, corners, size, side, false, lens[side]))
			return false;
	std::vector<std::vector<cv::Point3f>> places;
	std::vector<std::vector<cv::Point2f>> pixels[2];
	for (size_t i = 0; i < views.size(); i++) {
		const BoardPoints points = points_of(corners, static_cast<int>(i), -1);
		if (points.place.size() < 6)
			continue;
		places.push_back(points.place);
		for (int side = 0; side < 2; side++)
			pixels[side].push_back(points.pixel[side]);
	}
	cv::Mat R_right_left, t_right_left, E, F;
	cv::stereoCalibrate(places, pixels[0], pixels[1], lens[0].K, lens[0].D, lens[1].K, lens[1].D,
			    {size.width, size.height}, R_right_left, t_right_left, E, F,
			    cv::CALIB_USE_INTRINSIC_GUESS | cv::CALIB_FIX_K3,
			    {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-9});
	cv::Matx33d R;
	cv::Vec3d t;
	if (!camera_from_table(views, corners, PONG_LEFT, lens[0], R, t))
		return false;
	const cv::Matx33d R_relative = R_right_left;
	const cv::Vec3d t_relative = t_right_left;
	camera[PONG_LEFT] = camera_of(lens[0], R, t, size);
	camera[PONG_RIGHT] = camera_of(lens[1], R_relative * R, R_relative * t + t_relative, size);
	return true;
}

} // namespace bench
