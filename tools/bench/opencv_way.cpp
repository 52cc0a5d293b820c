#include "opencv_way.hpp"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace bench
{

namespace
{

const double threshold = 20;  // grey levels
const double area_least = 12; // px^2

cv::Mat view(const pong_image &image)
{
	return cv::Mat(image.height, image.width, CV_8UC1, const_cast<uint8_t *>(image.pixels),
		       static_cast<size_t>(image.stride));
}

bool hough_centre(const cv::Mat &picture, double radius, cv::Point2f *centre)
{
	std::vector<cv::Vec3f> circles;
	cv::HoughCircles(picture, circles, cv::HOUGH_GRADIENT, 1, picture.cols, 100, 8,
			 std::max(2, static_cast<int>(0.75 * radius)), static_cast<int>(1.25 * radius) + 1);
	if (circles.empty())
		return false;
	*centre = {circles[0][0], circles[0][1]};
	return true;
}

} // namespace

const char *rival_name(Rival rival)
{
	const char *names[] = {"moments", "minEnclosingCircle", "fitEllipse", "HoughCircles"};
	return names[static_cast<int>(rival)];
}

bool find_by_contour(const pong_pictures &pictures, const cv::Rect &where, Rival rival, double uv[2])
{
	const cv::Mat current = view(pictures.current)(where);
	cv::Mat difference, binary;
	cv::absdiff(current, view(pictures.earlier[0])(where), difference);
	cv::threshold(difference, binary, threshold, 255, cv::THRESH_BINARY);
	std::vector<std::vector<cv::Point>> contours;
	cv::findContours(binary, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
	size_t best = contours.size();
	double area = area_least;
	for (size_t i = 0; i < contours.size(); i++)
		if (cv::contourArea(contours[i]) > area) {
			best = i;
			area = cv::contourArea(contours[i]);
		}
	if (best == contours.size())
		return false;
	cv::Point2f centre;
	float radius;
	cv::minEnclosingCircle(contours[best], centre, radius);
	if (rival == Rival::moments) {
		const cv::Moments moments = cv::moments(contours[best]);
		centre = {static_cast<float>(moments.m10 / moments.m00), static_cast<float>(moments.m01 / moments.m00)};
	} else if (rival == Rival::ellipse) {
		centre = cv::fitEllipse(contours[best]).center;
	} else if (rival == Rival::hough && !hough_centre(current, radius, &centre)) {
		return false;
	}
	uv[0] = centre.x + where.x;
	uv[1] = centre.y + where.y;
	return true;
}

void triangulate_by_opencv(const pong_rig &rig, const double left[2], const double right[2], double position[3])
{
	const auto projection = [&](pong_side side) {
		return cv::Mat(3, 4, CV_64F, const_cast<double *>(&rig.camera[side].P[0][0]));
	};
	cv::Mat point;
	cv::triangulatePoints(projection(PONG_LEFT), projection(PONG_RIGHT),
			      cv::Mat(2, 1, CV_64F, const_cast<double *>(left)),
			      cv::Mat(2, 1, CV_64F, const_cast<double *>(right)), point);
	for (int axis = 0; axis < 3; axis++)
		position[axis] = point.at<double>(axis) / point.at<double>(3);
}

} // namespace bench
