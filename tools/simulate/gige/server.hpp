// Two (or more) GigE Vision cameras on loopback, spoken to by any GigE Vision client: discovery, control (GVCP), a
// GenICam description, and the picture stream (GVSP). They are exposed together by one trigger line, as a rig's are.
//
// What the cameras see comes from a PictureSource; this folder knows nothing of balls.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "faults.hpp"

namespace gige
{

// What the cameras look at.
class PictureSource
{
public:
	virtual ~PictureSource() = default;

	// The whole sensor of one camera as exposed by trigger pulse `pulse` (1, 2, ...), for `exposure` seconds, into
	// pixels[width * height]. Called from that camera's thread; calls for different cameras may run at once. It is
	// called ahead of the pulse, so that a picture leaves as soon as a real sensor's would.
	virtual void render(int camera, int64_t pulse, double exposure, uint8_t *pixels) = 0;

	// The pulse has come: when its exposure's middle is, in microseconds since the Unix epoch. Called once a pulse.
	virtual void exposed(int64_t pulse, int64_t utime) = 0;
};

struct CameraSettings {
	std::string address; // of this machine: "127.0.0.1"
	std::string serial;  // "SIML"
	int miss_every = 0;  // misses every so many-th trigger; 0: none
	std::vector<Fault> faults = {};
};

struct ServerSettings {
	std::vector<CameraSettings> cameras;
	int width = 640, height = 480; // of the sensor, px
	double rate = 110;             // of the trigger line, Hz
	double exposure = 0.002;       // until a client sets another one, s
	double link_rate = 1e9;        // packets are paced as this link would, bit/s
	uint64_t seed = 1;             // of what the faults leave to chance
	std::string trigger_socket; // where the line's edges come from, see edge_socket.hpp; empty: of the line's own
};

// What became of the trigger's pulses in one camera.
struct CameraCounts {
	int64_t pictures = 0; // sent
	int64_t missed = 0;   // because it was told to miss them
};

class Server
{
public:
	// Binds the sockets. Throws pong::Failure with a sentence where an address or port is not to be had.
	Server(const ServerSettings &settings, PictureSource &source);
	~Server();

	// Serve until pong::stop_requested(), or until `pulses` trigger pulses have come (0: no end). The trigger line
	// starts when all cameras stream, so that no client misses the beginning.
	void run(int64_t pulses);

	CameraCounts counts(int camera) const;

private:
	struct Implementation;
	std::unique_ptr<Implementation> implementation_;
};

} // namespace gige
