#include "report.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "error_map.hpp"
#include "program.hpp"

namespace calibrate
{

namespace
{

using pong::format;

const double stretch = 100; // residuals are drawn so much longer

const char style[] =
	"body{font:15px/1.45 system-ui,sans-serif;max-width:76em;margin:2em auto;padding:0 1em;color:#222}"
	"table{border-collapse:collapse}td,th{padding:.15em .8em;text-align:right;border-bottom:1px solid #ddd}"
	"td:first-child,th:first-child{text-align:left}img{width:100%;display:block}.pair{display:grid;"
	"grid-template-columns:1fr 1fr;gap:4px;margin-bottom:1.4em}.bad{color:#b00020}"
	".maps{display:grid;grid-template-columns:1fr 1fr;gap:2em}svg{width:100%;height:auto}";

std::string escaped(const std::string &text)
{
	std::string result;
	for (const char letter : text)
		result += letter == '<' ? "&lt;" : letter == '&' ? "&amp;" : std::string(1, letter);
	return result;
}

std::string base64(const std::vector<uchar> &bytes)
{
	const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
	std::string text;
	for (size_t i = 0; i < bytes.size(); i += 3) {
		unsigned group = 0;
		for (size_t k = 0; k < 3; k++)
			group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
		for (size_t k = 0; k < 4; k++)
			text += i + k > bytes.size() ? '=' : letters[group >> (18 - 6 * k) & 63];
	}
	return text;
}

std::string as_image(const cv::Mat &picture)
{
	std::vector<uchar> bytes;
	cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, 70});
	return "<img alt='' src='data:image/jpeg;base64," + base64(bytes) + "'>";
}

// Corners in green, residuals in red and longer than they are.
cv::Mat drawn(const Session &session, size_t pair, int side)
{
	cv::Mat picture;
	cv::cvtColor(session.pairs[pair].picture[static_cast<size_t>(side)], picture, cv::COLOR_GRAY2BGR);
	const auto used = std::find(session.used.begin(), session.used.end(), pair);
	const int view = used == session.used.end() ? -1 : static_cast<int>(used - session.used.begin());
	for (size_t i = 0; i < session.corners.size(); i++) {
		const pong_corner &corner = session.corners[i];
		if (corner.view != view || corner.side != side)
			continue;
		const cv::Point2d at(corner.uv[0], corner.uv[1]);
		const cv::Point2d miss(session.residuals[i][0], session.residuals[i][1]);
		cv::circle(picture, at, 3, {80, 200, 0}, 1, cv::LINE_AA);
		cv::line(picture, at, at + stretch * miss, {40, 40, 255}, 1, cv::LINE_AA);
	}
	return picture;
}

void write_volume(std::ofstream &page, const Volume &volume, const std::vector<Advice> &advice)
{
	if (!std::isfinite(volume.mean))
		return;
	page << format("<h2>Expected 3-D error</h2><p>From the calibration alone, root mean square, mm: <b>%.2f in the "
		       "mean, %.2f at most</b>, over the %.0f %% of the volume that both cameras see.</p>",
		       volume.mean, volume.worst, 100 * volume.seen)
	     << "<div class=maps>" << error_map(volume, {0, 2}, "From above, mm; the robot stands below")
	     << error_map(volume, {2, 1}, "From the side, mm; the robot stands on the left") << "</div>";
	if (advice.empty())
		return;
	page << "<p>One more board would help most:</p><ul>";
	for (const Advice &one : advice)
		page << format("<li>%s: %.2f mm</li>", one.text.c_str(), one.mean);
	page << "</ul>";
}

// The outline's points green, the corners red.
void write_table(std::ofstream &page, const TableView &table)
{
	if (table.name.empty())
		return;
	page << "<h2>The table</h2><p>" << escaped(table.name)
	     << ": points of the white lines' outer edges green, the corners that follow red.</p><div class=pair>";
	for (size_t side = 0; side < 2; side++) {
		cv::Mat picture;
		cv::cvtColor(table.picture[side], picture, cv::COLOR_GRAY2BGR);
		for (const cv::Point2d &point : table.edge[side])
			cv::circle(picture, point, 1, {80, 200, 0}, cv::FILLED, cv::LINE_AA);
		for (const cv::Point2d &corner : table.corners[side])
			cv::circle(picture, corner, 5, {40, 40, 255}, 1, cv::LINE_AA);
		page << as_image(picture);
	}
	page << "</div>";
}

void write_pictures(std::ofstream &page, const Session &session)
{
	page << format("<h2>Pictures</h2><p>Corners green; residuals red, %.0f times as long.</p>", stretch);
	for (size_t i = 0; i < session.pairs.size(); i++) {
		const Pair &pair = session.pairs[i];
		const auto used = std::find(session.used.begin(), session.used.end(), i);
		page << "<h3>" << escaped(pair.name) << "</h3>";
		if (!pair.rejected.empty())
			page << "<p class=bad>left out: " << escaped(pair.rejected) << "</p>";
		else if (used != session.used.end()) {
			const auto &result = session.results[static_cast<size_t>(used - session.used.begin())];
			page << format("<p>left %d corners, rms %.3f px; right %d corners, rms %.3f px</p>",
				       result.corners[0], result.rms[0], result.corners[1], result.rms[1]);
		}
		page << "<div class=pair>";
		for (const int side : {0, 1})
			if (!pair.picture[static_cast<size_t>(side)].empty())
				page << as_image(drawn(session, i, side));
		page << "</div>";
	}
}

} // namespace

void write_report(const std::string &path, const Session &session, const Volume &volume,
		  const std::vector<Advice> &advice)
{
	std::ofstream page(path);
	page << "<!doctype html><meta charset=utf-8><title>Calibration</title><style>" << style
	     << "</style><h1>Calibration</h1>"
	     << format("<p>%zu of %zu pairs, rms %.3f px.</p>", session.used.size(), session.pairs.size(),
		       session.calibration.rms);
	for (const std::string &note : session.notes)
		page << "<p>" << escaped(note) << "</p>";
	write_volume(page, volume, advice);
	write_table(page, session.table);
	write_pictures(page, session);
	page.close();
	if (!page)
		throw pong::Failure(path + ": cannot be written");
}

} // namespace calibrate
