// Where something that looks like a ball is new in a picture.
#include <vector>

#include "detector.hpp"
#include "error.hpp"
#include "region.hpp"

struct pong_detector {
	std::unique_ptr<pong::DetectMethod> method;
	int width, height;
};

namespace pong
{

namespace
{

pong_detector *make_detector(const pong_region &region, const pong_settings &settings)
{
	return new pong_detector{settings.detect.method == PONG_DETECT_DIFFERENCE
					 ? make_difference(region, settings)
					 : make_double_difference(region, settings),
				 region.width, region.height};
}

} // namespace

bool cluttered(const pong_detector &detector)
{
	return detector.method->cluttered();
}

int detect(pong_detector &detector, const pong_pictures &pictures, const pong_image *previous,
	   const pong_window *window, pong_detection *found, int capacity)
{
	if (capacity < 1 || searched_area(detector.width, detector.height, window).empty())
		return 0;
	detector.method->set_previous(previous);
	return detector.method->detect(pictures, window, found, capacity);
}

} // namespace pong

pong_detector *pong_detector_new(const pong_region *region, const pong_settings *settings, pong_error *error)
{
	return pong::guarded_new(error, [&] { return pong::make_detector(*region, *settings); });
}

void pong_detector_free(pong_detector *detector)
{
	delete detector;
}

void pong_detector_remember(pong_detector *detector, const pong_image *image)
{
	detector->method->remember(*image);
}

int pong_detect(pong_detector *detector, const pong_pictures *pictures, const pong_window *window,
		pong_detection *found, int capacity)
{
	return pong::detect(*detector, *pictures, nullptr, window, found, capacity);
}
