#pragma once
// The machine that the program runs on.

namespace greenwater {

/// Memory that a program may have here [bytes]: that of the machine, or less where the system sets a limit.
double machine_memory();

/// Processors that this program may use.
int machine_processors();

}  // namespace greenwater
