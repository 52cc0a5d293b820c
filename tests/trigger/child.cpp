#include "child.hpp"

#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <glib.h>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

namespace
{

constexpr unsigned PATIENCE_S = 60;

struct Ending {
	GMainLoop *loop;
	int status;
};

void on_exit_of(int pid, int status, gpointer ending)
{
	static_cast<Ending *>(ending)->status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
	g_main_loop_quit(static_cast<Ending *>(ending)->loop);
	g_spawn_close_pid(pid);
}

int on_patience_ended(gpointer pid)
{
	::kill(*static_cast<int *>(pid), SIGKILL);
	return G_SOURCE_REMOVE;
}

std::string read_file(const std::string &path)
{
	std::ostringstream text;
	text << std::ifstream(path).rdbuf();
	return text.str();
}

[[noreturn]] void become(const std::vector<std::string> &arguments, const std::vector<std::string> &environment,
			 const std::string &directory)
{
	dup2(open((directory + "/out").c_str(), O_WRONLY | O_CREAT, 0600), 1);
	dup2(open((directory + "/err").c_str(), O_WRONLY | O_CREAT, 0600), 2);
	for (const std::string &variable : environment)
		putenv(const_cast<char *>(variable.c_str()));
	std::vector<char *> words;
	words.reserve(arguments.size() + 1);
	for (const std::string &argument : arguments)
		words.push_back(const_cast<char *>(argument.c_str()));
	words.push_back(nullptr);
	execv(words[0], words.data());
	_exit(127);
}

} // namespace

Child::Child(const std::vector<std::string> &arguments, const std::vector<std::string> &environment)
{
	char name[] = "/tmp/pongeye-test-XXXXXX";
	if (!mkdtemp(name))
		throw std::runtime_error("no temporary folder");
	directory_ = name;
	pid_ = fork();
	if (pid_ == 0)
		become(arguments, environment, directory_);
}

Child::~Child()
{
	std::filesystem::remove_all(directory_);
}

void Child::kill(int signal) const
{
	::kill(pid_, signal);
}

Outcome Child::finish()
{
	Ending ending = {g_main_loop_new(nullptr, FALSE), -1};
	g_child_watch_add(pid_, on_exit_of, &ending);
	const guint patience = g_timeout_add_seconds(PATIENCE_S, on_patience_ended, &pid_);
	g_main_loop_run(ending.loop);
	if (GSource *source = g_main_context_find_source_by_id(nullptr, patience))
		g_source_destroy(source);
	g_main_loop_unref(ending.loop);
	return {ending.status, read_file(directory_ + "/out"), read_file(directory_ + "/err")};
}
