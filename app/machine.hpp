#pragma once
// The machine that the program runs on.

#include <string>

namespace greenwater {

/// Memory that a program may have here [bytes]: that of the machine, or less where the system sets a limit.
double machine_memory();

/// What the processor calls itself; "unknown" where the system does not tell.
std::string processor_name();

/// Processors that this program may use.
int machine_processors();

/// Takes back what OMP_PROC_BIND did to the first thread: for a program that is to be started now and binds itself.
void leave_processor();

}  // namespace greenwater
