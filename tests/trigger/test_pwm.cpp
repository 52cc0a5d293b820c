// pongeye-trigger --pwm as it is shipped, in a /sys that umockdev makes.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <glib.h>
#include <sstream>
#include <umockdev.h>

#include "child.hpp"

namespace
{

std::string program;

class PwmPort : public testing::Test
{
protected:
	PwmPort() : testbed(umockdev_testbed_new())
	{
		if (!umockdev_in_mock_environment())
			throw std::runtime_error("run by umockdev-wrapper");
		umockdev_testbed_add_device(testbed, "pwm", "pwmchip3", nullptr, "export", "", "unexport", "", nullptr,
					    nullptr);
		gchar *root = umockdev_testbed_get_root_dir(testbed);
		chip = std::string(root) + "/sys/devices/pwmchip3";
		g_free(root);
		std::filesystem::create_directory(chip + "/pwm1");
		for (const char *name : {"enable", "period", "duty_cycle", "polarity"})
			write(std::string("pwm1/") + name, "0\n");
	}

	~PwmPort() override
	{
		g_object_unref(testbed);
	}

	void write(const std::string &name, const std::string &text) const
	{
		std::ofstream(chip + "/" + name) << text;
	}

	std::string read(const std::string &name) const
	{
		std::ostringstream text;
		text << std::ifstream(chip + "/" + name).rdbuf();
		return text.str();
	}

	Outcome run(const std::vector<std::string> &options) const
	{
		std::vector<std::string> arguments = {program, "--lcm-url", "memq://", "--rate",
						      "110",   "--width",   "0.001"};
		arguments.insert(arguments.end(), options.begin(), options.end());
		return Child(arguments, {}).finish();
	}

	UMockdevTestbed *testbed;
	std::string chip;
};

TEST_F(PwmPort, RunsUntilTermAndLeavesTheChannelOff)
{
	Child child({program, "--lcm-url", "memq://", "--rate", "110", "--width", "0.001", "--polarity", "low", "--pwm",
		     "pwmchip3:1"},
		    {});
	for (int i = 0; i < 1000 && read("pwm1/enable") != "1"; i++)
		g_usleep(10'000);
	EXPECT_EQ(read("pwm1/enable"), "1");
	EXPECT_EQ(read("pwm1/period"), "9090909");
	EXPECT_EQ(read("pwm1/duty_cycle"), "1000000");
	EXPECT_EQ(read("pwm1/polarity"), "inversed");
	child.kill(SIGTERM);
	const Outcome outcome = child.finish();
	EXPECT_EQ(outcome.status, 0) << outcome.err;
	EXPECT_EQ(read("pwm1/enable"), "0");
	EXPECT_EQ(read("pwm1/duty_cycle"), "0");
	EXPECT_EQ(read("unexport"), "") << "it was exported before";
}

TEST_F(PwmPort, EndsAfterItsTime)
{
	EXPECT_EQ(run({"--pwm", "3:1", "--seconds", "0.05"}).status, 0);
	EXPECT_EQ(read("pwm1/polarity"), "normal");
	EXPECT_EQ(read("pwm1/enable"), "0");
}

TEST_F(PwmPort, RefusesWhatItCannot)
{
	Outcome outcome = run({"--pwm", "4:1"});
	EXPECT_EQ(outcome.status, 1);
	EXPECT_EQ(outcome.err, "pongeye-trigger: there is no PWM chip /sys/class/pwm/pwmchip4\n");
	outcome = run({"--pwm", "3:1", "--count", "5"});
	EXPECT_EQ(outcome.status, 2);
	EXPECT_EQ(outcome.err,
		  "pongeye-trigger: --pwm can neither count pulses nor wait for an outside edge: use --usb "
		  "(see --help)\n");
	EXPECT_EQ(read("pwm1/enable"), "0\n");
	write("pwm1/enable", "1\n");
	outcome = run({"--pwm", "3:1"});
	EXPECT_EQ(outcome.status, 1);
	EXPECT_EQ(outcome.err, "pongeye-trigger: /sys/class/pwm/pwmchip3/pwm1 is in use: it is enabled already\n");
}

} // namespace

int main(int argc, char **argv)
{
	testing::InitGoogleTest(&argc, argv);
	if (argc != 2) {
		fprintf(stderr, "usage: umockdev-wrapper %s PROGRAM\n", argv[0]);
		return 2;
	}
	program = argv[1];
	return RUN_ALL_TESTS();
}
