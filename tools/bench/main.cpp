// pongeye-bench: the paper's experiments, and ours.
#include <cstdio>
#include <cstring>

#include "commands.hpp"
#include "pongeye.h"
#include "program.hpp"

namespace
{

const struct {
	const char *name, *summary;
	int (*run)(int argc, char **argv);
} commands[] = {
	{"calibration", "compare calibrations: the paper's Fig. 9, or on pictures", bench::calibration},
	{"score", "score a tracker's output against a simulator's truth", bench::score},
	{"draw", "draw one flight, as the camera saw it and from the side", bench::draw},
	{"prediction", "predict simulated launches, beside the paper's way and the bound", bench::prediction},
	{"accuracy", "locate rendered balls by every method, ours and OpenCV's", bench::accuracy},
	{"speed", "time every stage, beside OpenCV's way", bench::speed},
};

void print_help()
{
	printf("usage: pongeye-bench COMMAND [OPTION ...]\n\nMeasure Pongeye, beside the paper and beside OpenCV's "
	       "way.\n\n"
	       "Commands (pongeye-bench COMMAND --help tells more):\n");
	for (const auto &command : commands)
		printf("  %-14s %s\n", command.name, command.summary);
	printf("\nExample:\n"
	       "  $ pongeye-simulate --scene paper66 --flights 5 --out flights\n"
	       "  $ pongeye-track --rig flights/rig.toml --images flights --output track.txt\n"
	       "  $ pongeye-bench score --truth flights/truth.txt --track track.txt --rig flights/rig.toml\n");
}

int run(int argc, char **argv)
{
	const char *name = argc > 1 ? argv[1] : "";
	if (!strcmp(name, "--help") || !strcmp(name, "-h")) {
		print_help();
		return 0;
	}
	if (!strcmp(name, "--version")) {
		printf("pongeye-bench %s\n", PONG_VERSION);
		return 0;
	}
	for (const auto &command : commands)
		if (!strcmp(name, command.name))
			return command.run(argc - 1, argv + 1);
	throw pong::UsageError(*name ? pong::format("no command '%s'", name) : "which benchmark?");
}

} // namespace

int main(int argc, char **argv)
{
	return pong::run_program("pongeye-bench", argc, argv, run);
}
