// Publishes what was seen over LCM: PONGEYE_BALL, PONGEYE_PREDICTION, PONGEYE_STATUS.
#pragma once

#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <string>
#include <vector>

#include "pongeye.h"
#include "pongeye/ball_t.hpp"
#include "pongeye/prediction_t.hpp"
#include "pongeye/status_t.hpp"
#include "status.hpp"

namespace track
{

class Recorder;

class Publisher
{
public:
	// url: LCM's, or empty for LCM's default. Throws pong::Failure where it cannot be opened.
	explicit Publisher(const std::string &url);

	// Where there is one.
	void publish_ball(const pong_sight &sight);
	void publish_prediction(const pong_sight &sight);

	void publish(const StatusReport &report);

	// Record what is published from now on. The recorder is the caller's, and outlives this.
	void record_to(Recorder &recorder)
	{
		recorder_ = &recorder;
	}

	// LCM's, as chosen.
	const std::string &url() const
	{
		return url_;
	}

private:
	template<class Message> void send(const char *channel, const Message &message, int64_t pair_utime);

	std::string url_;
	std::unique_ptr<lcm::LCM> lcm_;
	Recorder *recorder_ = nullptr;
	std::vector<uint8_t> encoded_;
	pongeye::ball_t ball_;
	pongeye::prediction_t prediction_;
	pongeye::status_t status_;
};

} // namespace track
