#pragma once
// The command line: which command, on which file. Everything else is in study/.

namespace elamin {

/// Does what the words of a command line ask for, the first of which is the program's name, and returns the exit status; prints to standard output
/// and error, catches what is thrown. For one caller at a time.
int command_line(int argc, char** argv);

}  // namespace elamin
