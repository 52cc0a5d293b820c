// pongeye-bench prediction: how well the hit is predicted, ours beside the paper's and others', beside the bound.
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>

#include <Eigen/Dense>

#include "commands.hpp"
#include "launches.hpp"
#include "options.hpp"
#include "program.hpp"

namespace bench
{

namespace
{

struct TrackFree {
	void operator()(pong_track *track) const
	{
		pong_track_free(track);
	}
};

// Sums over flights.
struct Score {
	double distance = 0, time = 0, normalised = 0;
	int count = 0, missing = 0;
	void add(const pong_prediction &prediction, const Launch &launch)
	{
		if (!prediction.has_hit) {
			missing++;
			return;
		}
		const sim::Hit &truth = *launch.flight.hit();
		const double t = static_cast<double>(prediction.hit.utime - 1000000000) * 1e-6;
		Eigen::Vector3d error(prediction.hit.position[0] - truth.position.x(),
				      prediction.hit.position[1] - truth.position.y(), t - truth.time);
		distance += error.head<2>().norm();
		time += std::abs(error.z());
		Eigen::Matrix3d covariance;
		const int place[3] = {0, 1, 3};
		for (int i = 0; i < 3; i++)
			for (int j = 0; j < 3; j++)
				covariance(i, j) = prediction.hit_covariance[place[i]][place[j]];
		normalised += error.dot(covariance.inverse() * error) / 3;
		count++;
	}
};

} // namespace

int prediction(int argc, char **argv)
{
	int seeds = 6;
	LaunchSettings settings;
	double kick = -1, grip = 0.05, spin = -1;
	pong::Options options("pongeye-bench prediction", "Predict simulated launches.", "");
	options.integer("--seeds", "6", "noise drawn so often for each flight", &seeds, 1, 1000);
	options.number("--noise", "0.1", "of a centre, px", &settings.noise, 0.001, 10);
	options.number("--kick", "-1", "kick", &kick, -1, 10);
	options.number("--grip", "-1", "grip", &grip, -1, 10);
	options.number("--spin", "-1", "spin prior", &spin, -1, 1000);
	if (!options.parse(argc, argv))
		return 0;
	const sim::Rig sim_rig = sim::make_rig({});
	pong_rig rig;
	pong_error error;
	if (pong_rig_parse(sim::rig_text(sim_rig, 0).c_str(), "rig", &rig, &error) < 0)
		throw pong::Failure(error.text);
	const double before[] = {0.5, 0.4, 0.3, 0.2, 0.1, 0.0};
	for (const double revolutions : {5., 30., 100.}) {
		settings.spin = revolutions;
		const Spread spread = spread_of(settings);
		std::fill_n(rig.ball.spin_sigma, 3, spin >= 0 ? spin : spread.spin);
		rig.ball.drag = 0.47;
		rig.ball.drag_sigma = spread.drag;
		rig.ball.magnus = 4.65e-6;
		rig.ball.magnus_saturation = 0;
		rig.ball.drag_by_spin = 0;
		rig.ball.grip = 0;
		rig.ball.magnus_sigma = spread.magnus;
		rig.ball.restitution_sigma = spread.restitution;
		rig.ball.friction_sigma = spread.friction;
		if (kick >= 0)
			rig.ball.kick = kick;
		if (grip >= 0)
			rig.ball.grip_sigma = grip;
		const auto launches = draw_launches(sim_rig, settings);
		Score score[2][6];
		Bound bound[6] = {};
		double seconds = 0;
		int points = 0;
		sim::Random random(7);
		for (const Launch &launch : launches) {
			for (int k = 0; k < 6; k++) {
				const Bound b = prediction_bound(sim_rig, launch, launch.flight.hit()->time - before[k], settings);
				bound[k].distance += b.distance / launches.size();
				bound[k].time += b.time / launches.size();
			}
			for (int seed = 0; seed < seeds; seed++) {
				const auto measured = measure(sim_rig, rig, launch, settings, random);
				for (int profile = 0; profile < 2; profile++) {
					pong_settings library;
					pong_settings_defaults(profile ? PONG_BEST : PONG_PAPER, &library);
					std::unique_ptr<pong_track, TrackFree> track(pong_track_new(&rig, &library, &error));
					pong_prediction prediction = {};
					int k = 0;
					const auto begin = std::chrono::steady_clock::now();
					for (size_t i = 0; i <= measured.size(); i++) {
						const double t = i < measured.size() ? (measured[i].utime - 1000000000) * 1e-6 : 1e9;
						while (k < 6 && t > launch.flight.hit()->time - before[k]) {
							if (i >= 3)
								score[profile][k].add(prediction, launch);
							else
								score[profile][k].missing++;
							k++;
						}
						if (i == measured.size())
							break;
						pong_track_push(track.get(), &measured[i]);
						pong_state state;
						prediction.has_hit = 0;
						if (pong_track_state(track.get(), &state))
							pong_predict(&rig, &state, &library, &prediction);
						if (profile)
							points++;
					}
					if (profile)
						seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
				}
			}
		}
		printf("spin to %g rev/s: %.1f us a point\n", revolutions, 1e6 * seconds / points);
		for (int k = 0; k < 6; k++) {
			printf("  %.1f s before: bound %.2f cm %.2f ms", before[k], 100 * bound[k].distance, 1000 * bound[k].time);
			for (const auto &of : score) {
				const Score &s = of[k];
				printf(" | %6.2f cm %6.2f ms NEES %.2f (%d, %d missing)", 100 * s.distance / s.count, 1000 * s.time / s.count,
				       s.normalised / s.count, s.count, s.missing);
			}
			printf(" ratio %.3f\n", score[1][k].distance / score[1][k].count / bound[k].distance);
		}
	}
	return 0;
}

} // namespace bench
