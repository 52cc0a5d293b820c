#include "folder.hpp"

#include <cmath>
#include <filesystem>
#include <optional>

#include <opencv2/imgcodecs.hpp>

#include "program.hpp"
#include "renderer.hpp"
#include "text_file.hpp"
#include "truth.hpp"

namespace sim
{

namespace
{

// The pictures of one camera, into the folder.
class Photographer
{
public:
	Photographer(const FolderSettings &settings, const Scene &scene, const Camera &camera, uint64_t seed, int side)
		: path_(settings.path), side_(side == 0 ? "left" : "right"), duration_(scene.picture.exposure),
		  renderer_(scene, camera, seed, side), picture_(camera.height, camera.width, CV_8UC1)
	{
	}

	void take(int64_t frame, double time, const Episode *episode)
	{
		renderer_.render(episode, {time, duration_, static_cast<uint64_t>(frame)}, picture_.data);
		const std::string name =
			pong::format("%s/%06lld-%s.png", path_.c_str(), static_cast<long long>(frame), side_);
		if (!cv::imwrite(name, picture_, {cv::IMWRITE_PNG_COMPRESSION, 1}))
			throw pong::Failure(name + ": cannot write");
	}

private:
	const std::string path_;
	const char *side_;
	const double duration_;
	Renderer renderer_;
	cv::Mat picture_;
};

// What the pictures don't tell, as cameras do.
std::string exposure_text(double exposure)
{
	return pong::format("\n[locate]\nexposure = %g # s\n", exposure);
}

void make_folder(const std::string &path)
{
	std::error_code error;
	std::filesystem::create_directories(path, error);
	if (error)
		throw pong::Failure(path + ": cannot make this folder: " + error.message());
	for (const auto &entry : std::filesystem::directory_iterator(path, error))
		if (entry.path().extension() == ".png") {
			pong::say(path +
				  " holds pictures already: those that are not written anew stay among the new ones");
			return;
		}
}

} // namespace

int64_t write_folder(const FolderSettings &settings, const Scene &scene, uint64_t seed)
{
	make_folder(settings.path);
	const Rig rig = make_rig(scene.rig);
	write_text(settings.path + "/rig.toml", rig_text(rig, scene.hit_z) + exposure_text(scene.picture.exposure));
	Truth truth(settings.path + "/truth.txt", rig);
	std::optional<BoardTruth> boards;
	if (scene.show == Show::board)
		boards.emplace(settings.path + "/boards.txt");
	World world(scene, rig, seed, settings.rate, 1);
	Photographer left(settings, scene, rig[0], seed, 0), right(settings, scene, rig[1], seed, 1);
	int64_t frame = 0;
	for (; frame < settings.frames && !pong::stop_requested(); frame++) {
		const double time = static_cast<double>(frame) / settings.rate;
		const int64_t utime = std::llround(1e6 * time);
		const auto episode = world.at(time);
		left.take(frame, time, episode.get());
		right.take(frame, time, episode.get());
		truth.add(utime, frame, episode.get(), time);
		if (boards && episode)
			boards->add(utime, frame, *episode);
		if ((frame + 1) % 500 == 0)
			pong::say(pong::format("%lld of %lld frames", static_cast<long long>(frame + 1),
					       static_cast<long long>(settings.frames)));
	}
	return frame;
}

} // namespace sim
