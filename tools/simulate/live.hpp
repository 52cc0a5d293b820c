// The world as the GigE Vision cameras see it, pulse by pulse.
#pragma once

#include <memory>
#include <string>

#include "gige/server.hpp"
#include "renderer.hpp"
#include "truth.hpp"

namespace sim
{

// Trigger pulse n shows the world at (n - 1) / rate.
class LiveWorld : public gige::PictureSource
{
public:
	// `truth_path` may be empty: then no truth is written.
	LiveWorld(const Scene &scene, uint64_t seed, double rate, const std::string &truth_path);

	void render(int camera, int64_t pulse, double exposure, uint8_t *pixels) override;
	void exposed(int64_t pulse, int64_t utime) override;

private:
	double time_of(int64_t pulse) const;

	const double rate_;
	const Rig rig_;
	World world_;
	std::array<std::unique_ptr<Renderer>, 2> renderers_;
	std::unique_ptr<Truth> truth_;
};

} // namespace sim
