// The simulated cameras, seen through Aravis as the tracker sees real ones: the real server in a thread, real sockets.
// What a busy machine loses is not judged: of the pictures that arrive all must be right, and a few must arrive.
#include <arv.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>
#include <thread>

#include "gige/server.hpp"
#include "program.hpp"

namespace
{

constexpr int width = 640, height = 480;
constexpr double rate = 110;
constexpr size_t enough = 20; // pictures of a run that is long enough for 100

// A row of the pattern: every pixel tells camera, pulse and place. Copied from a ramp, so that even a sanitizer's build
// keeps pace with the cameras.
const uint8_t *row_of(int camera, int64_t pulse, int v)
{
	static const std::vector<uint8_t> ramp = [] {
		std::vector<uint8_t> values(256 + width);
		std::iota(values.begin(), values.end(), uint8_t{0});
		return values;
	}();
	return &ramp[static_cast<uint8_t>(camera * 100 + pulse * 7 + 3 * v)];
}

class Pattern : public gige::PictureSource
{
public:
	void render(int camera, int64_t pulse, double, uint8_t *pixels) override
	{
		for (int v = 0; v < height; v++)
			memcpy(pixels + v * width, row_of(camera, pulse, v), width);
		memcpy(pixels, &pulse, sizeof pulse);
	}

	void exposed(int64_t pulse, int64_t utime) override
	{
		const std::lock_guard<std::mutex> lock(mutex_);
		utimes_[pulse] = utime;
	}

	std::map<int64_t, int64_t> utimes() const
	{
		const std::lock_guard<std::mutex> lock(mutex_);
		return utimes_;
	}

private:
	mutable std::mutex mutex_;
	std::map<int64_t, int64_t> utimes_;
};

gige::ServerSettings server_settings()
{
	gige::ServerSettings settings;
	settings.cameras = {{"127.0.0.1", "SIML"}, {"127.0.0.2", "SIMR"}};
	settings.width = width;
	settings.height = height;
	settings.rate = rate;
	return settings;
}

// Another run may hold the port for a moment.
std::unique_ptr<gige::Server> open_server(gige::PictureSource &source)
{
	for (int attempt = 1;; attempt++) {
		try {
			return std::make_unique<gige::Server>(server_settings(), source);
		} catch (const pong::Failure &) {
			if (attempt == 20)
				throw;
			std::this_thread::sleep_for(std::chrono::milliseconds(500));
		}
	}
}

struct Picture {
	int64_t pulse;
	uint64_t timestamp;
};

// A client, with the camera's settings as it likes them: the camera has those of its last client.
struct Client {
	explicit Client(const char *address) : camera(arv_camera_new(address, nullptr))
	{
		if (!camera || !is_controller())
			return;
		arv_camera_set_region(camera, 0, 0, width, height, nullptr);
		arv_camera_set_exposure_time(camera, 2000, nullptr);
		arv_camera_set_gain(camera, 0, nullptr);
		arv_camera_set_chunk_mode(camera, FALSE, nullptr);
	}

	~Client()
	{
		g_clear_object(&stream);
		g_clear_object(&camera);
	}
	Client(const Client &) = delete;
	Client &operator=(const Client &) = delete;

	bool is_controller() const
	{
		return arv_gv_device_is_controller(ARV_GV_DEVICE(arv_camera_get_device(camera)));
	}

	void open_stream()
	{
		arv_camera_gv_set_stream_options(camera, ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
		stream = arv_camera_create_stream(camera, nullptr, nullptr, nullptr);
		ASSERT_TRUE(stream);
		g_object_set(stream, "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED, "socket-buffer-size", 4 << 20,
			     "packet-timeout", 20000, "initial-packet-timeout", 20000, "frame-retention", 200000,
			     nullptr);
		for (int i = 0; i < 32; i++)
			arv_stream_push_buffer(stream,
					       arv_buffer_new(arv_camera_get_payload(camera, nullptr), nullptr));
	}

	void start()
	{
		arv_camera_start_acquisition(camera, &error);
		ASSERT_FALSE(error) << error->message;
	}

	ArvCamera *camera = nullptr;
	ArvStream *stream = nullptr;
	GError *error = nullptr;
};

// One server for all tests, as one is on for many clients.
class GigeAravis : public testing::Test
{
protected:
	static void SetUpTestSuite()
	{
		server = open_server(source);
		serving = std::thread([] { server->run(0); });
	}

	static void TearDownTestSuite()
	{
		pong::request_stop();
		if (serving.joinable())
			serving.join();
		server.reset();
	}

	static inline Pattern source;
	static inline std::unique_ptr<gige::Server> server;
	static inline std::thread serving;
};

// The picture of a complete buffer, its pixels checked.
Picture check_picture(ArvBuffer *buffer, int camera)
{
	size_t size = 0;
	const auto *data = static_cast<const uint8_t *>(arv_buffer_get_data(buffer, &size));
	Picture picture = {0, arv_buffer_get_timestamp(buffer)};
	memcpy(&picture.pulse, data, sizeof picture.pulse);
	const int told = sizeof picture.pulse; // of row 0
	int wrong = memcmp(data + told, row_of(camera, picture.pulse, 0) + told, width - told) != 0;
	for (int v = 1; v < height; v++)
		wrong += memcmp(data + v * width, row_of(camera, picture.pulse, v), width) != 0;
	EXPECT_EQ(wrong, 0) << "rows, camera " << camera << ", pulse " << picture.pulse;
	return picture;
}

// What arrives complete within some seconds, up to `count`.
template<typename Look> void receive(Client &client, size_t count, Look look)
{
	size_t complete = 0;
	const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
	while (complete < count && std::chrono::steady_clock::now() < end) {
		ArvBuffer *buffer = arv_stream_timeout_pop_buffer(client.stream, 200000);
		if (!buffer)
			continue;
		if (arv_buffer_get_status(buffer) == ARV_BUFFER_STATUS_SUCCESS) {
			complete++;
			look(buffer);
		}
		arv_stream_push_buffer(client.stream, buffer);
	}
}

std::map<int64_t, uint64_t> timestamps(const std::vector<Picture> &pictures)
{
	std::map<int64_t, uint64_t> by_pulse;
	for (const Picture &picture : pictures)
		by_pulse[picture.pulse] = picture.timestamp;
	return by_pulse;
}

} // namespace

TEST_F(GigeAravis, TwoTriggeredCamerasSeeTheSamePulses)
{
	Client clients[2] = {Client("127.0.0.1"), Client("127.0.0.2")};
	std::vector<Picture> pictures[2];
	for (Client &client : clients) {
		ASSERT_TRUE(client.camera);
		ASSERT_TRUE(client.is_controller());
		arv_camera_set_trigger(client.camera, "Line1", &client.error);
		ASSERT_FALSE(client.error) << client.error->message;
		client.open_stream();
	}
	for (Client &client : clients)
		client.start();
	std::thread receivers[2];
	for (int i = 0; i < 2; i++)
		receivers[i] = std::thread([&, i] {
			receive(clients[i], 110,
				[&](ArvBuffer *buffer) { pictures[i].push_back(check_picture(buffer, i)); });
		});
	for (std::thread &receiver : receivers)
		receiver.join();
	for (Client &client : clients)
		arv_camera_stop_acquisition(client.camera, nullptr);

	const auto left = timestamps(pictures[0]), right = timestamps(pictures[1]);
	const auto utimes = source.utimes();
	size_t pairs = 0;
	int64_t clock_offset = 0;
	for (const auto &[pulse, timestamp] : left) {
		// Pulse n comes n - 1 periods after the first, to the nanosecond; truth knows the middle of the
		// exposure.
		const auto ticks = static_cast<int64_t>(timestamp - left.begin()->second);
		const double periods = static_cast<double>(pulse) - static_cast<double>(left.begin()->first);
		EXPECT_NEAR(static_cast<double>(ticks), periods * 1e9 / rate, 1.01);
		ASSERT_TRUE(utimes.count(pulse));
		EXPECT_NEAR(static_cast<double>(utimes.at(pulse) - utimes.at(left.begin()->first)),
			    static_cast<double>(ticks) / 1000, 200);
		if (!right.count(pulse))
			continue;
		const auto offset = static_cast<int64_t>(right.at(pulse) - timestamp);
		if (pairs++ == 0)
			clock_offset = offset;
		EXPECT_EQ(offset, clock_offset) << "pulse " << pulse;
	}
	EXPECT_GE(pairs, enough);
	EXPECT_EQ(utimes.begin()->first, 1);
	EXPECT_EQ(utimes.size(), static_cast<size_t>(utimes.rbegin()->first)) << "a pulse was not reported";
}

TEST_F(GigeAravis, FeaturesReadBackAndLimitsHold)
{
	Client client("127.0.0.1");
	ASSERT_TRUE(client.camera);
	arv_camera_set_exposure_time(client.camera, 1500, &client.error);
	arv_camera_set_gain(client.camera, 6, &client.error);
	arv_camera_set_region(client.camera, 64, 32, 320, 240, &client.error);
	arv_camera_set_frame_rate(client.camera, 55, &client.error);
	ASSERT_FALSE(client.error) << client.error->message;
	EXPECT_DOUBLE_EQ(arv_camera_get_exposure_time(client.camera, nullptr), 1500);
	EXPECT_DOUBLE_EQ(arv_camera_get_gain(client.camera, nullptr), 6);
	EXPECT_DOUBLE_EQ(arv_camera_get_frame_rate(client.camera, nullptr), 55);
	gint x = 0, y = 0, w = 0, h = 0, least = 0, most = 0;
	arv_camera_get_region(client.camera, &x, &y, &w, &h, nullptr);
	EXPECT_EQ(x, 64);
	EXPECT_EQ(y, 32);
	EXPECT_EQ(w, 320);
	EXPECT_EQ(h, 240);
	arv_camera_get_width_bounds(client.camera, &least, &most, nullptr);
	EXPECT_EQ(most, width - 64);
	EXPECT_EQ(arv_camera_get_payload(client.camera, nullptr), 320u * 240);
	EXPECT_STREQ(arv_camera_get_device_serial_number(client.camera, nullptr), "SIML");
	arv_camera_set_integer(client.camera, "Width", 640, &client.error);
	EXPECT_TRUE(client.error) << "the region would leave the sensor";
	g_clear_error(&client.error);
}

TEST_F(GigeAravis, ASecondClientGetsNoControlUntilTheFirstLeaves)
{
	{
		Client first("127.0.0.1");
		ASSERT_TRUE(first.camera);
		EXPECT_TRUE(first.is_controller());
		Client second("127.0.0.1");
		ASSERT_TRUE(second.camera);
		EXPECT_FALSE(second.is_controller());
		arv_camera_set_exposure_time(second.camera, 700, &second.error);
		EXPECT_TRUE(second.error);
		g_clear_error(&second.error);
		EXPECT_DOUBLE_EQ(arv_camera_get_exposure_time(second.camera, nullptr), 2000);
	}
	Client third("127.0.0.1");
	ASSERT_TRUE(third.camera);
	EXPECT_TRUE(third.is_controller());
}

TEST_F(GigeAravis, AFreeRunningCameraSendsItsRegionWithChunks)
{
	Client client("127.0.0.2");
	ASSERT_TRUE(client.camera);
	arv_camera_set_region(client.camera, 64, 32, 320, 240, &client.error);
	arv_camera_set_frame_rate(client.camera, 100, &client.error);
	arv_camera_set_exposure_time(client.camera, 1000, &client.error);
	arv_camera_set_chunk_mode(client.camera, TRUE, &client.error);
	ASSERT_FALSE(client.error) << client.error->message;
	ArvChunkParser *parser = arv_camera_create_chunk_parser(client.camera);
	client.open_stream();
	client.start();
	size_t looked = 0;
	receive(client, enough, [&](ArvBuffer *buffer) {
		looked++;
		ASSERT_TRUE(arv_buffer_has_chunks(buffer));
		GError *error = nullptr;
		EXPECT_EQ(arv_chunk_parser_get_integer_value(parser, buffer, "ChunkFrameID", &error),
			  static_cast<gint64>(arv_buffer_get_frame_id(buffer)));
		EXPECT_EQ(arv_chunk_parser_get_integer_value(parser, buffer, "ChunkTimestamp", &error),
			  static_cast<gint64>(arv_buffer_get_timestamp(buffer)));
		EXPECT_DOUBLE_EQ(arv_chunk_parser_get_float_value(parser, buffer, "ChunkExposureTime", &error), 1000);
		EXPECT_EQ(arv_chunk_parser_get_integer_value(parser, buffer, "ChunkLineStatusAll", &error), 0);
		EXPECT_EQ(arv_chunk_parser_get_integer_value(parser, buffer, "ChunkCounterValue", &error),
			  static_cast<gint64>(source.utimes().size()));
		EXPECT_FALSE(error) << error->message;
		g_clear_error(&error);
		size_t size = 0;
		const auto *data = static_cast<const uint8_t *>(arv_buffer_get_data(buffer, &size));
		EXPECT_EQ(arv_buffer_get_image_width(buffer), 320);
		EXPECT_EQ(arv_buffer_get_image_x(buffer), 64);
		// The pulse is unknown here, but neighbours differ by what the pattern says.
		for (int v = 1; v < 240; v++)
			for (int u = 0; u < 320; u += 40)
				ASSERT_EQ(data[v * 320 + u], static_cast<uint8_t>(data[0] + u + 3 * v));
	});
	arv_camera_stop_acquisition(client.camera, nullptr);
	g_object_unref(parser);
	EXPECT_EQ(looked, enough);
}

TEST_F(GigeAravis, SoftwareTriggersTakeOnePictureEach)
{
	Client client("127.0.0.1");
	ASSERT_TRUE(client.camera);
	arv_camera_set_trigger(client.camera, "Software", &client.error);
	client.open_stream();
	client.start();
	size_t arrived = 0;
	for (int i = 0; i < 5; i++) {
		arv_camera_software_trigger(client.camera, &client.error);
		ASSERT_FALSE(client.error) << client.error->message;
		ArvBuffer *buffer = arv_stream_timeout_pop_buffer(client.stream, 2000000);
		ASSERT_TRUE(buffer);
		if (arv_buffer_get_status(buffer) == ARV_BUFFER_STATUS_SUCCESS) {
			check_picture(buffer, 0);
			arrived++;
		}
		arv_stream_push_buffer(client.stream, buffer);
	}
	EXPECT_FALSE(arv_stream_timeout_pop_buffer(client.stream, 50000)) << "a picture that nobody triggered";
	arv_camera_stop_acquisition(client.camera, nullptr);
	EXPECT_GE(arrived, 3u);
}

TEST_F(GigeAravis, PacketSizesAreFoundByTestPackets)
{
	Client client("127.0.0.1");
	ASSERT_TRUE(client.camera);
	arv_camera_gv_set_packet_size(client.camera, 1500, &client.error);
	ASSERT_FALSE(client.error) << client.error->message;
	arv_gv_device_set_packet_size_adjustment(ARV_GV_DEVICE(arv_camera_get_device(client.camera)),
						 ARV_GV_PACKET_SIZE_ADJUSTMENT_NEVER);
	EXPECT_GE(arv_camera_gv_auto_packet_size(client.camera, &client.error), 8000u);
	ASSERT_FALSE(client.error) << client.error->message;
}

TEST_F(GigeAravis, TheLatchedClockRunsInNanoseconds)
{
	Client client("127.0.0.1");
	ASSERT_TRUE(client.camera);
	gint64 device[2], host[2];
	for (int i = 0; i < 2; i++) {
		host[i] = g_get_monotonic_time();
		arv_camera_execute_command(client.camera, "TimestampLatch", &client.error);
		device[i] = arv_camera_get_integer(client.camera, "TimestampLatchValue", &client.error);
		ASSERT_FALSE(client.error) << client.error->message;
		g_usleep(100000);
	}
	EXPECT_NEAR(static_cast<double>(device[1] - device[0]) / 1000, static_cast<double>(host[1] - host[0]), 50000);
}

TEST_F(GigeAravis, ASecondServerSaysWhyItCannotBe)
{
	try {
		const gige::Server second(server_settings(), source);
		FAIL() << "two servers on one port";
	} catch (const pong::Failure &failure) {
		EXPECT_NE(std::string(failure.what()).find("127.0.0.1, port 3956"), std::string::npos)
			<< failure.what();
	}
}

TEST_F(GigeAravis, ImpossibleSettingsAreRefused)
{
	gige::ServerSettings settings = server_settings();
	settings.width = 641;
	EXPECT_THROW(gige::Server(settings, source), pong::Failure);
	settings = server_settings();
	settings.cameras.clear();
	EXPECT_THROW(gige::Server(settings, source), pong::Failure);
	settings = server_settings();
	settings.rate = 0;
	EXPECT_THROW(gige::Server(settings, source), pong::Failure);
}

TEST_F(GigeAravis, IsDiscovered)
{
	arv_update_device_list();
	std::vector<std::string> ids;
	for (unsigned i = 0; i < arv_get_n_devices(); i++)
		ids.push_back(arv_get_device_id(i));
	EXPECT_EQ(std::count(ids.begin(), ids.end(), "Pongeye-Simulated-SIML"), 1) << testing::PrintToString(ids);
	EXPECT_EQ(std::count(ids.begin(), ids.end(), "Pongeye-Simulated-SIMR"), 1);
}
