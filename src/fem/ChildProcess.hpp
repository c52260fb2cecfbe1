#pragma once

/// Work of a library that may end the process that it runs in.

#include <functional>
#include <string>

namespace epafi::fem {

/// Calls `work` in a copy of this process and waits for it. Whatever the copy does, this process goes on: it may call exit(), throw
/// where nobody can catch, or read where there is nothing. What it leaves is what it writes to files. The copy has one thread, this one.
///
/// \param name  who works, and on what, for errors: `Gmsh, at work on "bolt.geo",`
/// \param remedy  what to do if the copy ends before the work is done
/// \throws InputError or Error with the same text if `work` throws one; InputError if the copy ends before; Error if none can be made.
/// Not collective.
void inChildProcess(const std::function<void()>& work, const std::string& name, const std::string& remedy);

} // namespace epafi::fem
