#include "settings.hpp"

#include "program.hpp"

namespace pong
{

double period_of(const Settings &settings)
{
	return 1 / settings.rate;
}

double exposure_of(const Settings &settings)
{
	return settings.exposure > 0 ? settings.exposure : settings.width;
}

void check_settings(const Settings &settings)
{
	const double period = period_of(settings);
	if (settings.width >= period)
		throw UsageError(format("--width %g s does not fit into the period of %g s at %g Hz", settings.width,
					period, settings.rate));
	if (exposure_of(settings) >= period)
		throw UsageError(format("--exposure %g s does not fit into the period of %g s at %g Hz",
					settings.exposure, period, settings.rate));
}

} // namespace pong
