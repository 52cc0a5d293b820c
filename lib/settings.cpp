// The numbers of every stage. docs/ say where each comes from.
#include "pongeye.h"

#include "document.hpp"
#include "error.hpp"

namespace pong
{

namespace
{

// Where a setting stands in a rig.toml, and what it may be.
struct Number {
	const char *section, *key;
	double *value;
	double min, max;
};

void read_numbers(const Document &document, pong_settings &settings)
{
	const Number numbers[] = {
		{"region", "ceiling", &settings.region.ceiling, 0.05, 10},
		{"region", "margin", &settings.region.margin, 0, 10},
		{"region", "behind", &settings.region.behind, 0, 20},
		{"detect", "contrast", &settings.detect.contrast, 1, 255},
		{"locate", "sigma", &settings.locate.sigma, 0.001, 10},
		{"locate", "exposure", &settings.locate.exposure, 0, 0.1},
		{"reconstruct", "epipolar", &settings.reconstruct.epipolar, 0.01, 100},
		{"reconstruct", "epipolar_size", &settings.reconstruct.epipolar_size, 0, 10},
		{"reconstruct", "size", &settings.reconstruct.size, 0.01, 10},
		{"track", "gate", &settings.track.gate, 0.001, 10},
		{"track", "gate_rate", &settings.track.gate_rate, 0, 100},
		{"track", "lost", &settings.track.lost, 0.001, 10},
		{"track", "noise", &settings.track.noise, 0, 1},
		{"track", "speed", &settings.track.speed, 0.1, 200},
		{"predict", "step", &settings.predict.step, 0.00001, 0.1},
		{"predict", "horizon", &settings.predict.horizon, 0.01, 10},
		{"predict", "path_step", &settings.predict.path_step, 0.001, 10},
		{"window", "margin", &settings.window.margin, 0, 1000},
		{"window", "diameters", &settings.window.diameters, 0, 100},
	};
	for (const Number &number : numbers)
		if (document.has(number.section, number.key))
			*number.value = document.number(number.section, number.key, number.min, number.max);
}

// The place of a setting's word in a list of words.
int read_word(const Document &document, const char *section, const char *key, std::initializer_list<const char *> words)
{
	const std::string text = document.text(section, key);
	int place = 0;
	std::string known;
	for (const char *word : words) {
		if (text == word)
			return place;
		known += (place++ ? ", " : "") + std::string(word);
	}
	document.refuse(section, key, "must be one of " + known);
}

void read_settings(const Document &document, pong_settings &settings)
{
	const std::pair<const char *, std::vector<std::string>> sections[] = {
		{"region", {"ceiling", "margin", "behind", "distance"}},
		{"detect", {"method", "gap", "contrast"}},
		{"locate", {"method", "sigma", "exposure"}},
		{"reconstruct", {"method", "epipolar", "epipolar_size", "size"}},
		{"track", {"state", "gate", "gate_rate", "lost", "speed", "noise"}},
		{"predict", {"method", "step", "horizon", "path_step"}},
		{"window", {"margin", "diameters"}},
	};
	for (const auto &[section, keys] : sections)
		if (document.has_section(section))
			document.allow_only(section, keys);
	read_numbers(document, settings);
	if (document.has("region", "distance")) {
		const auto distance = document.numbers("region", "distance", 2);
		if (!(distance[0] > 0 && distance[1] > distance[0]))
			document.refuse("region", "distance", "needs a lesser and a greater distance in metres");
		settings.region.distance[0] = distance[0];
		settings.region.distance[1] = distance[1];
	}
	if (document.has("detect", "method"))
		settings.detect.method = static_cast<pong_detect_method>(
			read_word(document, "detect", "method", {"difference", "double-difference"}));
	if (document.has("detect", "gap"))
		settings.detect.gap = static_cast<int>(document.number("detect", "gap", 1, PONG_GAP_MAX));
	if (document.has("locate", "method"))
		settings.locate.method = static_cast<pong_locate_method>(
			read_word(document, "locate", "method", {"gaussian", "centroid", "edges", "photometric"}));
	if (document.has("reconstruct", "method"))
		settings.reconstruct.method = static_cast<pong_reconstruct_method>(
			read_word(document, "reconstruct", "method", {"linear", "likely"}));
	if (document.has("track", "state"))
		settings.track.state =
			static_cast<pong_state_method>(read_word(document, "track", "state", {"two-halves", "flight"}));
	if (document.has("predict", "method"))
		settings.predict.method =
			static_cast<pong_predict_method>(read_word(document, "predict", "method", {"euler", "spin"}));
}

// All that the document says, or nothing.
void change_settings(const Document &document, pong_settings *settings)
{
	pong_settings changed = *settings;
	read_settings(document, changed);
	*settings = changed;
}

} // namespace

} // namespace pong

void pong_settings_defaults(pong_profile profile, pong_settings *settings)
{
	*settings = {};
	settings->region.ceiling = 1.2;
	settings->region.margin = 0.2;
	settings->region.behind = 1;
	settings->region.distance[0] = 0.5;
	settings->region.distance[1] = 12;
	settings->detect.method = profile == PONG_PAPER ? PONG_DETECT_DIFFERENCE : PONG_DETECT_DOUBLE_DIFFERENCE;
	settings->detect.gap = 8;
	settings->detect.contrast = profile == PONG_PAPER ? 8 : 3;
	settings->locate.method = profile == PONG_PAPER ? PONG_LOCATE_GAUSSIAN : PONG_LOCATE_PHOTOMETRIC;
	settings->locate.sigma = 0.3;
	settings->reconstruct.method = profile == PONG_PAPER ? PONG_RECONSTRUCT_LINEAR : PONG_RECONSTRUCT_LIKELY;
	settings->reconstruct.epipolar = 1.5;
	settings->reconstruct.epipolar_size = 0.1;
	settings->reconstruct.size = 0.35;
	settings->track.state = profile == PONG_PAPER ? PONG_STATE_TWO_HALVES : PONG_STATE_FLIGHT;
	settings->track.gate = 0.15;
	settings->track.gate_rate = 2;
	settings->track.lost = profile == PONG_PAPER ? 0.1 : 0.6;
	settings->track.speed = 40;
	settings->track.noise = 0.0022;
	settings->predict.method = profile == PONG_PAPER ? PONG_PREDICT_EULER : PONG_PREDICT_SPIN;
	settings->predict.step = 0.001;
	settings->predict.horizon = 1.5;
	settings->predict.path_step = 0.02;
	settings->window.margin = profile == PONG_PAPER ? 10 : 7;
	settings->window.diameters = profile == PONG_PAPER ? 1 : 0.3;
}

int pong_settings_parse(const char *text, const char *name, pong_settings *settings, pong_error *error)
{
	return pong::guarded(error, [&] {
		pong::change_settings(pong::Document(text, name), settings);
		return PONG_FOUND;
	});
}

int pong_settings_load(const char *path, pong_settings *settings, pong_error *error)
{
	return pong::guarded(error, [&] {
		pong::change_settings(pong::Document(pong::read_file(path), path), settings);
		return PONG_FOUND;
	});
}
