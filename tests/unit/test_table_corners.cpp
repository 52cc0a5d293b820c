// The table's corners in rendered pictures of the empty room, whose cameras are known.
#include <gtest/gtest.h>

#include "tools/calibrate/table_corners.hpp"
#include "tools/simulate/renderer.hpp"

namespace
{

using calibrate::TableCorners;

// Farther back and higher than the usual rig, so that all four corners are in view.
sim::Scene wide_scene(const std::string &distortion)
{
	return sim::parse_scene("[rig]\nfocal = 640\nbehind = 1.7\nabove = 0.9\npitch = 14\ndistortion = [" +
					distortion + "]\n",
				"wide");
}

struct Rendered {
	cv::Mat picture;
	TableCorners truth;
};

Rendered render(const sim::Scene &scene, int side, uint64_t seed)
{
	const sim::Camera camera = sim::make_rig(scene.rig)[static_cast<size_t>(side)];
	Rendered result;
	result.picture.create(camera.height, camera.width, CV_8U);
	sim::Renderer renderer(scene, camera, seed, side);
	renderer.render(nullptr, {0, 0.002, 1}, result.picture.data);
	const double x[] = {0.7625, -0.7625, -0.7625, 0.7625}, z[] = {0, 0, 2.74, 2.74};
	for (size_t i = 0; i < 4; i++) {
		Eigen::Vector2d pixel;
		EXPECT_TRUE(camera.project({x[i], 0, z[i]}, &pixel));
		result.truth[i] = {pixel.x(), pixel.y()};
	}
	return result;
}

void expect_near(const TableCorners &corners, const TableCorners &truth, double pixels)
{
	for (size_t i = 0; i < 4; i++)
		EXPECT_LT(cv::norm(corners[i] - truth[i]), pixels) << "corner " << i << ": " << corners[i] << truth[i];
}

TEST(TableCorners, AreRefinedFromRoughClicks)
{
	for (const char *distortion : {"0, 0, 0, 0, 0", "-0.15, 0, 0, 0, 0"})
		for (const int side : {0, 1}) {
			const Rendered table = render(wide_scene(distortion), side, 1);
			TableCorners rough = table.truth;
			const cv::Point2d clicks[] = {{6, -4}, {-5, 5}, {4, 3}, {-6, -2}};
			for (size_t i = 0; i < 4; i++)
				rough[i] += clicks[i];
			expect_near(calibrate::refine_table(table.picture, rough).corners, table.truth, 0.3);
		}
}

TEST(TableCorners, AreFoundFreely)
{
	for (const uint64_t seed : {1, 2, 3})
		for (const int side : {0, 1}) {
			const Rendered table = render(wide_scene("-0.15, 0, 0, 0, 0"), side, seed);
			expect_near(
				calibrate::refine_table(table.picture, calibrate::find_table(table.picture)).corners,
				table.truth, 0.3);
		}
}

void expect_refusal(const cv::Mat &picture, const TableCorners &rough, const char *words)
{
	try {
		calibrate::refine_table(picture, rough);
		ADD_FAILURE() << "nothing is refused";
	} catch (const std::exception &failure) {
		EXPECT_NE(std::string(failure.what()).find(words), std::string::npos) << failure.what();
	}
}

TEST(TableCorners, AreRefusedWhereThereAreNone)
{
	const Rendered table = render(wide_scene("0, 0, 0, 0, 0"), 0, 1);
	TableCorners elsewhere = table.truth;
	for (cv::Point2d &corner : elsewhere)
		corner = cv::Point2d(320, 200) + 0.5 * (corner - cv::Point2d(320, 200));
	expect_refusal(table.picture, elsewhere, "is not seen as a white line");
	TableCorners turned = table.truth;
	std::reverse(turned.begin(), turned.end());
	expect_refusal(table.picture, turned, "near left, near right, far right, far left");
	EXPECT_THROW(calibrate::find_table(cv::Mat(480, 640, CV_8U, cv::Scalar(90))), std::exception);
}

// Something lies over a third of the far end.
TEST(TableCorners, BearWhatHidesPartOfALine)
{
	Rendered table = render(wide_scene("0, 0, 0, 0, 0"), 0, 1);
	const cv::Point2d from = table.truth[3] + 0.2 * (table.truth[2] - table.truth[3]);
	const cv::Point2d to = table.truth[3] + 0.5 * (table.truth[2] - table.truth[3]);
	table.picture(cv::Rect(cv::Point(from) - cv::Point(0, 12), cv::Point(to) + cv::Point(0, 12))).setTo(120);
	expect_near(calibrate::refine_table(table.picture, table.truth).corners, table.truth, 0.3);
}

} // namespace
