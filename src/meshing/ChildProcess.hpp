#pragma once

/// Work of a library that may end the process that it runs in.

#include <functional>
#include <string>

namespace epafi::meshing {

/// Calls `work` in a copy of this process and waits for it. Whatever the copy does, this process goes on: it
/// may call exit(), throw where nobody can catch, read where there is nothing, or wait for itself. What it
/// leaves is what it writes to files. The copy has one thread, this one.
///
/// \param name  who works, and on what, for errors: `Gmsh, at work on "bolt.geo",`
/// \param remedy  what to do if the copy ends before the work is done
/// \throws InputError or Error with the same text if `work` throws one; InputError if the copy ends before,
/// or uses no processor for so long; Error if none can be made. Not collective.
/// \param patience  seconds without the processor
void inChildProcess(const std::function<void()>& work, const std::string& name, const std::string& remedy,
                    int patience = 60);

} // namespace epafi::meshing
