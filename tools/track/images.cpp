#include "images.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <opencv2/imgcodecs.hpp>

#include "clock.hpp"
#include "program.hpp"
#include "table.hpp"

namespace track
{

namespace
{

bool is_number(const std::string &name)
{
	constexpr size_t DIGITS_OF_INT64 = 18;
	return !name.empty() && name.size() <= DIGITS_OF_INT64 &&
	       name.find_first_not_of("0123456789") == std::string::npos;
}

// Numbers come before words, and in the order of their values: 9 before 10.
struct NameOrder {
	bool operator()(const std::string &a, const std::string &b) const
	{
		const bool number_a = is_number(a), number_b = is_number(b);
		if (number_a != number_b)
			return number_a;
		if (number_a && std::stoll(a) != std::stoll(b))
			return std::stoll(a) < std::stoll(b);
		return a < b;
	}
};

using FilesByName = std::map<std::string, ImageFiles, NameOrder>;

// "003-left.png" with ending "-left.png": true, and name = "003".
bool strip_ending(const std::string &file, const std::string &ending, std::string &name)
{
	if (file.size() <= ending.size() || file.compare(file.size() - ending.size(), ending.size(), ending) != 0)
		return false;
	name = file.substr(0, file.size() - ending.size());
	return true;
}

FilesByName find_files(const std::string &folder)
{
	std::error_code error;
	std::filesystem::directory_iterator entries(folder, error);
	if (error)
		throw pong::Failure(folder + ": " + error.message());
	FilesByName files;
	for (const std::filesystem::directory_entry &entry : entries) {
		std::string name;
		if (strip_ending(entry.path().filename().string(), "-left.png", name))
			files[name].left = entry.path().string();
		else if (strip_ending(entry.path().filename().string(), "-right.png", name))
			files[name].right = entry.path().string();
	}
	if (files.empty())
		throw pong::Failure(folder + ": no pictures NAME-left.png, NAME-right.png in this folder");
	return files;
}

void set_times_by_number(FilesByName &files, double fps)
{
	for (auto &[name, pair] : files) {
		pair.frame = std::stoll(name);
		pair.utime = std::llround(static_cast<double>(pair.frame) * 1e6 / fps);
	}
}

void set_times_by_table(FilesByName &files, const std::string &path)
{
	const pong::Table table(path);
	const size_t frame = table.column("frame"), utime = table.column("utime");
	if (table.rows() != files.size())
		throw pong::Failure(pong::format("%s: %zu rows for %zu picture names; there must be one for each",
						 path.c_str(), table.rows(), files.size()));
	size_t row = 0;
	for (auto &[name, pair] : files) {
		pair.frame = table.get_integer(row, frame);
		pair.utime = table.get_integer(row++, utime);
	}
}

class ImageSource : public Source
{
public:
	ImageSource(const std::string &folder, double fps, double exposure)
		: files_(list_images(folder, fps)), exposure_us_(static_cast<int32_t>(std::lround(exposure * 1e6)))
	{
		const auto is_alone = [](const ImageFiles &files) { return files.left.empty() || files.right.empty(); };
		const auto alone = std::find_if(files_.begin(), files_.end(), is_alone);
		if (alone == files_.end())
			return;
		const std::string example = alone->left.empty() ? alone->right : alone->left;
		const auto pairs_end = std::remove_if(files_.begin(), files_.end(), is_alone);
		dropped_.unpaired = files_.end() - pairs_end;
		files_.erase(pairs_end, files_.end());
		if (files_.empty())
			throw pong::Failure(folder + ": no picture has a partner of the other side");
		pong::say(pong::format("%s has no partner of the other side: skipped (%lld such in all)",
				       example.c_str(), static_cast<long long>(dropped_.unpaired)));
	}

	Next next(StereoPair &pair) override
	{
		if (next_ == files_.size())
			return Next::END;
		const ImageFiles &files = files_[next_++];
		pair.utime = files.utime;
		pair.frame = files.frame;
		pair.left = read(files.left, left_);
		pair.right = read(files.right, right_);
		pair.arrival_ns = monotonic_ns();
		pair.exposure_us[PONG_LEFT] = pair.exposure_us[PONG_RIGHT] = exposure_us_;
		return Next::PAIR;
	}

	Dropped dropped() const override
	{
		return dropped_;
	}

private:
	static pong_image read(const std::string &path, cv::Mat &picture)
	{
		try {
			picture = cv::imread(path, cv::IMREAD_GRAYSCALE);
		} catch (const cv::Exception &) {
			picture.release();
		}
		if (picture.empty())
			throw pong::Failure(path + ": cannot be read as a picture");
		return {picture.data, picture.cols, picture.rows, static_cast<ptrdiff_t>(picture.step[0])};
	}

	std::vector<ImageFiles> files_;
	const int32_t exposure_us_;
	size_t next_ = 0;
	cv::Mat left_, right_;
	Dropped dropped_;
};

} // namespace

std::vector<ImageFiles> list_images(const std::string &folder, double fps)
{
	FilesByName files = find_files(folder);
	const std::string times = folder + "/times.txt";
	const bool numbered = is_number(files.rbegin()->first); // words sort last
	const bool has_times = std::filesystem::exists(times);
	if (numbered && (fps > 0 || !has_times))
		set_times_by_number(files, fps > 0 ? fps : DEFAULT_FPS);
	else if (has_times)
		set_times_by_table(files, times);
	else
		throw pong::Failure(
			pong::format("%s: picture name '%s' is not a frame number, and there is no times.txt "
				     "with columns frame and utime",
				     folder.c_str(), files.rbegin()->first.c_str()));
	std::vector<ImageFiles> list;
	for (auto &[name, pair] : files)
		list.push_back(std::move(pair));
	return list;
}

std::unique_ptr<Source> open_images(const std::string &folder, double fps, double exposure)
{
	return std::make_unique<ImageSource>(folder, fps, exposure);
}

} // namespace track
