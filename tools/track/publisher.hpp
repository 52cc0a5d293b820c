// Publishes what was seen over LCM: PONGEYE_BALL, PONGEYE_PREDICTION, PONGEYE_STATUS.
#pragma once

#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <string>

#include "pongeye.h"
#include "pongeye/ball_t.hpp"
#include "pongeye/prediction_t.hpp"
#include "pongeye/status_t.hpp"
#include "status.hpp"

namespace track
{

class Publisher
{
public:
	// url: LCM's, or empty for LCM's default. Throws pong::Failure where it cannot be opened.
	explicit Publisher(const std::string &url);

	// The ball and the prediction, where there are any.
	void publish(const pong_sight &sight);

	void publish(const StatusReport &report);

	// LCM's, as chosen.
	const std::string &url() const
	{
		return url_;
	}

private:
	template<class Message> void send(const char *channel, const Message &message);

	std::string url_;
	std::unique_ptr<lcm::LCM> lcm_;
	pongeye::ball_t ball_;
	pongeye::prediction_t prediction_;
	pongeye::status_t status_;
};

} // namespace track
