#include <algorithm>
#include <arv.h>
#include <cstdio>
#include <string>

#include "cameras.hpp"
#include "program.hpp"

namespace track
{

namespace
{

// One cell of a table has no blanks.
std::string cell(const char *text)
{
	std::string word = text && *text ? text : "-";
	std::replace(word.begin(), word.end(), ' ', '_');
	return word;
}

} // namespace

void list_cameras()
{
	arv_update_device_list();
	const unsigned count = arv_get_n_devices();
	if (count == 0)
		throw pong::Failure(
			"no GigE Vision camera answers on any network interface, and there is no USB3 Vision "
			"camera");
	printf("# address serial protocol vendor model id\n");
	for (unsigned i = 0; i < count; i++)
		printf("%s %s %s %s %s %s\n", cell(arv_get_device_address(i)).c_str(),
		       cell(arv_get_device_serial_nbr(i)).c_str(), cell(arv_get_device_protocol(i)).c_str(),
		       cell(arv_get_device_vendor(i)).c_str(), cell(arv_get_device_model(i)).c_str(),
		       cell(arv_get_device_id(i)).c_str());
}

} // namespace track
