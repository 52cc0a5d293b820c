#include "arguments.hpp"

#include <cmath>
#include <cstring>
#include <glob.h>

#include "options.hpp"
#include "program.hpp"

namespace calibrate
{

namespace
{

const char example[] =
	"  $ pongeye-simulate --scene board --seed 1 --out b\n"
	"  $ pongeye-calibrate --board 9x6 --square 0.025 --left b/*-left.png --right b/*-right.png \\\n"
	"        --flat 000000 --flat-at 0,0.76,0 --flat-sigma 0.0002,0.001 --output rig.toml >pairs.txt\n"
	"  looking for boards: 40 of 40 pictures\n"
	"  20 of 20 pairs are used\n"
	"  rms 0.0882 px; squares measure 25.000 mm, are 25.000 mm (+0.001 %)\n"
	"  expected 3-D error 2.45 mm in the mean, 8.29 mm at most, over the 49 % of the volume in view";

// Take the values of an option that may have many out of argv: everything up to the next option. A pattern that no
// shell has expanded is expanded here.
std::vector<std::string> take_list(std::vector<char *> &arguments, const char *option)
{
	std::vector<std::string> files;
	for (size_t i = 1; i < arguments.size(); i++) {
		if (strcmp(arguments[i], option))
			continue;
		size_t end = i + 1;
		for (; end < arguments.size() && strncmp(arguments[end], "--", 2); end++) {
			glob_t matches = {};
			glob(arguments[end], GLOB_NOCHECK, nullptr, &matches);
			files.insert(files.end(), matches.gl_pathv, matches.gl_pathv + matches.gl_pathc);
			globfree(&matches);
		}
		if (end == i + 1)
			throw pong::UsageError(std::string(option) + " needs files");
		arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(i),
				arguments.begin() + static_cast<std::ptrdiff_t>(end));
		i--;
	}
	return files;
}

// Numbers with commas between; "-" is absent where that is allowed.
std::vector<double> numbers(const char *option, const std::string &text, bool absent_allowed = false)
{
	std::vector<double> result;
	const char *at = text.c_str();
	for (;;) {
		char *end;
		double value = strtod(at, &end);
		if (end == at && *at == '-' && absent_allowed) {
			value = NAN;
			end++;
		} else if (end == at || !std::isfinite(value)) {
			throw pong::UsageError(std::string(option) + " needs numbers with commas between, not '" +
					       text + "'");
		}
		result.push_back(value);
		if (!*end)
			return result;
		if (*end != ',')
			throw pong::UsageError(std::string(option) + " needs numbers with commas between, not '" +
					       text + "'");
		at = end + 1;
	}
}

void fill(const char *option, const std::string &text, double *values, size_t count)
{
	if (text.empty())
		return;
	const auto list = numbers(option, text);
	if (list.size() != count)
		throw pong::UsageError(pong::format("%s needs %zu numbers, has %zu", option, count, list.size()));
	std::copy(list.begin(), list.end(), values);
}

void read_board(const std::string &text, BoardSize &board)
{
	char end;
	if (sscanf(text.c_str(), "%dx%d%c", &board.columns, &board.rows, &end) != 2 || board.columns < 3 ||
	    board.rows < 3 || board.columns > 100 || board.rows > 100)
		throw pong::UsageError("--board needs the numbers of inner corners, such as 9x6, not '" + text + "'");
}

void check(const Arguments &arguments, const std::string &board)
{
	const bool live = !arguments.cameras.empty();
	if (!arguments.refine.empty()) {
		if (arguments.rig.empty())
			throw pong::UsageError("--refine-from needs --rig, the calibration that is to be refined");
		return;
	}
	if (board.empty() || arguments.board.square <= 0)
		throw pong::UsageError("--board and --square say what the board is: both are needed");
	if (!live && (arguments.files[0].empty() || arguments.files[1].empty()))
		throw pong::UsageError("--left and --right need pictures");
	if (arguments.plane_z.size() > arguments.files[0].size() && !live)
		throw pong::UsageError("--plane-z names more planes than there are pictures");
	if (arguments.profile == PONG_PAPER && arguments.plane_z.size() < 2)
		throw pong::UsageError("--profile paper needs --plane-z with two planes at least");
	for (const auto &table : arguments.table)
		if (!table.empty() && table.size() != 8)
			throw pong::UsageError(
				"the table's corners are 8 numbers: u,v of near left, near right, far right, "
				"far left; -,- for one that is not seen");
	if (arguments.table[0].empty() != arguments.table[1].empty())
		throw pong::UsageError("--table-left and --table-right belong together");
	const bool placed = !arguments.plane_z.empty() || !arguments.flat.empty() || !arguments.table_pair.empty() ||
			    !arguments.table[0].empty();
	if (!placed && !arguments.no_table && arguments.check.empty())
		throw pong::UsageError(
			"where is the table? --plane-z, --flat, --table, or --table-left and --table-right say it; "
			"--no-table makes the left camera the frame");
}

} // namespace

bool parse_arguments(int argc, char **argv, Arguments &arguments)
{
	std::vector<char *> rest(argv, argv + argc);
	arguments.files[PONG_LEFT] = take_list(rest, "--left");
	arguments.files[PONG_RIGHT] = take_list(rest, "--right");
	arguments.refine = take_list(rest, "--refine-from");
	std::string board, plane_z, plane_at, plane_sigma, flat_at, flat_sigma, table[2], files_seen;
	int knocked = PONG_RIGHT;
	pong::Options options("pongeye-calibrate",
			      "Calibrate two cameras from pictures of a chessboard, and say how far the result can be "
			      "trusted.",
			      example);
	options.text("--board", "COLSxROWS", "inner corners of the chessboard", &board);
	options.number("--square", "METRES", "side of its squares, m", &arguments.board.square, 0.001, 10);
	options.text("--left", "FILE ...", "pictures of the left camera", &files_seen);
	options.text("--right", "FILE ...", "pictures of the right camera, in pairs with the left ones", &files_seen);
	options.choice("--profile", {"paper", "best"}, "the paper's linear method, or the joint refinement (best)",
		       &arguments.profile);
	options.text("--plane-z", "Z,Z,...", "the first pictures show the board upright at these z, m", &plane_z);
	options.text("--plane-at", "X,Y", "where its middle is on the planes, m (0,0.3)", &plane_at);
	options.text("--plane-sigma", "M,RAD", "how well it was placed (0.0005,0.002)", &plane_sigma);
	options.text("--flat", "NAME", "the pair whose board lies on the table, rows across it", &arguments.flat);
	options.text("--flat-at", "X,Z,Y", "where its middle is, and the board's thickness, m (0,0.6,0)", &flat_at);
	options.text("--flat-sigma", "M,RAD", "how well it was placed (0.001,0.002)", &flat_sigma);
	options.text("--table", "NAME", "the pair in which the table's corners are found, by its white lines",
		     &arguments.table_pair);
	options.text(
		"--table-left", "U,V,...",
		"pixels of the table's corners in the left picture: near left, near right, far right, far left; -,-: "
		"not seen. With --table: roughly, to be refined there",
		&table[PONG_LEFT]);
	options.text("--table-right", "U,V,...", "the same in the right picture", &table[PONG_RIGHT]);
	options.number("--table-sigma", "METRES",
		       "hold the table to its size, so well; without: its size is a check only", &arguments.table_sigma,
		       1e-5, 1);
	options.flag("--no-table", "there is no table: the frame is the left camera's", &arguments.no_table);
	options.text("--output", "FILE", "the rig, - for stdout (rig.toml)", &arguments.output);
	options.text("--report", "FILE", "a page with pictures and residuals", &arguments.report);
	options.number("--accept", "MM",
		       "a greater expected 3-D error is too poor to play with, mm (5; without a table any will do)",
		       &arguments.accept, 0.01, 1000);
	options.flag("--force", "write the rig even if it is too poor", &arguments.force);
	options.text("--check", "RIG", "calibrate nothing: score this rig.toml on the pictures", &arguments.check);
	options.text("--cameras", "RIG", "collect the pictures live from the cameras that this rig.toml names",
		     &arguments.cameras);
	options.integer("--pairs", "N", "with --cameras: how many (24)", &arguments.pairs, 4, 1000);
	options.text("--save", "DIR", "with --cameras: keep the pictures here, to calibrate from them again",
		     &arguments.save);
	options.text("--refine-from", "FLIGHTS ...",
		     "correct --rig after a knock, from tables that pongeye-track --output wrote", &files_seen);
	options.text("--rig", "RIG", "the rig.toml that --refine-from corrects", &arguments.rig);
	options.choice("--knocked", {"left", "right"}, "the camera that was knocked (right)", &knocked);
	if (!options.parse(static_cast<int>(rest.size()), rest.data()))
		return false;
	if (!board.empty())
		read_board(board, arguments.board);
	if (!plane_z.empty())
		arguments.plane_z = numbers("--plane-z", plane_z);
	fill("--plane-at", plane_at, arguments.plane_at, 2);
	fill("--plane-sigma", plane_sigma, arguments.plane_sigma, 2);
	fill("--flat-at", flat_at, arguments.flat_at, 3);
	fill("--flat-sigma", flat_sigma, arguments.flat_sigma, 2);
	for (const int side : {PONG_LEFT, PONG_RIGHT})
		if (!table[side].empty())
			arguments.table[side] = numbers(side ? "--table-right" : "--table-left", table[side], true);
	arguments.knocked = static_cast<pong_side>(knocked);
	check(arguments, board);
	return true;
}

} // namespace calibrate
