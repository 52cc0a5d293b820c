// pongeye-calibrate: pictures of a board in, rig.toml out, and how far it can be trusted.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "arguments.hpp"
#include "camera_placement.hpp"
#include "live.hpp"
#include "program.hpp"
#include "refine.hpp"
#include "report.hpp"
#include "rig_file.hpp"
#include "session.hpp"
#include "table_view.hpp"
#include "volume.hpp"

namespace
{

using namespace calibrate;

void tell_pairs(const Session &session)
{
	for (const Pair &pair : session.pairs)
		if (!pair.rejected.empty())
			fprintf(stderr, "%s: left out: %s\n", pair.name.c_str(), pair.rejected.c_str());
		else
			for (size_t side = 0; side < 2; side++)
				if (pair.found[side].corners.empty())
					fprintf(stderr, "%s: seen by the %s camera only: %s\n", pair.name.c_str(),
						side ? "left" : "right", pair.found[side].why.c_str());
	fprintf(stderr, "%zu of %zu pairs are used\n", session.used.size(), session.pairs.size());
}

void tell_views(const Session &session)
{
	printf("# pair left_corners right_corners left_rms_px right_rms_px\n");
	for (size_t i = 0; i < session.used.size(); i++)
		printf("%s %d %d %.4f %.4f\n", session.pairs[session.used[i]].name.c_str(),
		       session.results[i].corners[0], session.results[i].corners[1], session.results[i].rms[0],
		       session.results[i].rms[1]);
}

void tell_volume(const Volume &volume, const std::vector<Advice> &advice)
{
	if (!std::isfinite(volume.mean)) {
		fprintf(stderr, "this method does not know how far it is off\n");
		return;
	}
	fprintf(stderr,
		"expected 3-D error %.2f mm in the mean, %.2f mm at most, over the %.0f %% of the volume in view\n",
		volume.mean, volume.worst, 100 * volume.seen);
	for (const Advice &one : advice)
		fprintf(stderr, "one more board %s would make it %.2f mm\n", one.text.c_str(), one.mean);
}

// Why a calibration is not to be played with; empty where it is.
std::string too_poor(const Arguments &arguments, const Session &session, const Volume &volume)
{
	const std::string wrong = misplaced(session.calibration.camera, !arguments.no_table);
	if (!wrong.empty())
		return wrong;
	if (arguments.profile == PONG_PAPER)
		return session.calibration.rms > 1
			       ? pong::format("corners miss by %.1f px rms", session.calibration.rms)
			       : "";
	if (!std::isfinite(volume.mean))
		return "no place of the volume is in view of both cameras";
	const double accept = arguments.accept > 0 ? arguments.accept : arguments.no_table ? INFINITY : 5;
	if (volume.mean <= accept)
		return "";
	return pong::format(
		"points are expected to be %.1f mm off, more than the %.1f mm of --accept; %zu pairs are used",
		volume.mean, accept, session.used.size());
}

int check_rig(const Arguments &arguments, Session &session)
{
	pong_rig rig;
	pong_error error;
	if (pong_rig_load(arguments.check.c_str(), &rig, &error) < 0)
		throw pong::Failure(error.text);
	build_views(arguments, session);
	tell_pairs(session);
	if (session.used.empty())
		throw pong::Failure("no board was found in any picture");
	session.calibration.rms = score(rig.camera, session);
	std::copy_n(rig.camera, 2, session.calibration.camera);
	for (auto &row : session.calibration.covariance)
		std::fill(std::begin(row), std::end(row), NAN);
	tell_views(session);
	const double square = measured_square(rig.camera, arguments.board, session);
	fprintf(stderr, "rms %.4f px; squares measure %.3f mm, are %.3f mm (%+.3f %%)\n", session.calibration.rms,
		1e3 * square, 1e3 * arguments.board.square, 100 * (square / arguments.board.square - 1));
	if (!arguments.report.empty())
		write_report(arguments.report, session, {{}, NAN, NAN, 0}, {});
	return 0;
}

// Calibrated live, the cameras go on being found as before.
void keep_ids(const std::string &path, pong_rig *rig)
{
	pong_rig before;
	pong_error error;
	if (pong_rig_load(path.c_str(), &before, &error) < 0)
		throw pong::Failure(error.text);
	for (int side = 0; side < 2; side++)
		std::copy_n(before.camera[side].id, sizeof before.camera[side].id, rig->camera[side].id);
}

int calibrate_rig(const Arguments &arguments, Session &session)
{
	locate_table(arguments, session);
	solve(arguments, session);
	tell_pairs(session);
	if (arguments.output != "-")
		tell_views(session);
	const bool table = !arguments.no_table;
	const auto grid = volume_grid(session, table);
	const Volume volume = expect_error(session.calibration, grid);
	std::vector<Advice> advice;
	if (std::isfinite(volume.mean))
		advice = advise(session, arguments.board, grid);
	const double square = measured_square(session.calibration.camera, arguments.board, session);
	fprintf(stderr, "rms %.4f px; squares measure %.3f mm, are %.3f mm (%+.3f %%)\n", session.calibration.rms,
		1e3 * square, 1e3 * arguments.board.square, 100 * (square / arguments.board.square - 1));
	fprintf(stderr, "%s\n", describe_placement(session.calibration.camera).c_str());
	tell_volume(volume, advice);
	for (const std::string &note : session.notes)
		fprintf(stderr, "%s\n", note.c_str());
	if (!arguments.report.empty())
		write_report(arguments.report, session, volume, advice);
	const std::string poor = too_poor(arguments, session, volume);
	if (!poor.empty()) {
		pong::say("no rig to play with: " + poor + (arguments.force ? "" : "; --force writes it all the same"));
		if (!arguments.force)
			return 1;
	}
	pong_rig rig = make_rig(session.calibration.camera, table);
	if (!arguments.cameras.empty())
		keep_ids(arguments.cameras, &rig);
	write_rig(arguments.output, rig,
		  describe_calibration(session, volume, static_cast<pong_profile>(arguments.profile)));
	return 0;
}

int run(int argc, char **argv)
{
	Arguments arguments;
	if (!parse_arguments(argc, argv, arguments))
		return 0;
	if (!arguments.refine.empty())
		return refine(arguments);
	Session session;
	if (!arguments.cameras.empty()) {
		session.pairs = collect(arguments);
	} else {
		session.pairs = pair_files(arguments.files[PONG_LEFT], arguments.files[PONG_RIGHT]);
		find_boards(arguments.board, session.pairs);
	}
	return arguments.check.empty() ? calibrate_rig(arguments, session) : check_rig(arguments, session);
}

} // namespace

int main(int argc, char **argv)
{
	return pong::run_program("pongeye-calibrate", argc, argv, run);
}
