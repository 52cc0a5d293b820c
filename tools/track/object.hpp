// Owns an object of GLib's.
#pragma once

#include <glib-object.h>
#include <memory>

namespace track
{

struct ObjectDeleter {
	void operator()(gpointer object) const
	{
		g_object_unref(object);
	}
};
template<class T> using Object = std::unique_ptr<T, ObjectDeleter>;

} // namespace track
