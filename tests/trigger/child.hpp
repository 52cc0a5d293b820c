// A program run by a test, whose main loop meanwhile plays the machine around it.
#pragma once

#include <string>
#include <vector>

struct Outcome {
	int status = -1; // exit status; -1 where a signal ended it, or patience
	std::string out, err;
};

class Child
{
public:
	// Starts `arguments`, with `environment` ("NAME=value") besides our own.
	Child(const std::vector<std::string> &arguments, const std::vector<std::string> &environment);
	~Child();
	Child(const Child &) = delete;
	Child &operator=(const Child &) = delete;

	void kill(int signal) const;
	// Runs the main loop until the program has ended, or for 60 s.
	Outcome finish();

private:
	std::string directory_;
	int pid_;
};
