#pragma once

namespace elamin {

/// What this machine has, or this program's limit (ulimit -v) where that is less [bytes].
double all_memory();

/// What this program can have without taking it from others, or beyond its limit (ulimit -v) [bytes]; infinity where the system does not tell.
double free_memory();

/// Lets this program keep up to 256 MB that it has freed, for what it asks for next, in blocks of up to 32 MB. Every factorisation frees and asks for the same
/// blocks; memory that goes back to the system between them comes again page by page, which takes much of the time of small problems. For programs
/// alone to call, before their first factorisation: it is about all of their memory. Nothing where the C library is not glibc.
void keep_freed_memory();

/// Holds some memory back, which the first allocation by `new` that fails gives free before it throws std::bad_alloc, so that there is room to say so and to
/// write what was found. For programs alone to call: it sets the handler of `new`.
void hold_memory_back();

/// Gives that memory free, where something else than `new` has found none. Nothing where it is given, or none was held.
void give_held_memory() noexcept;

/// Whether it is given free: what goes wrong behind it may do so for lack of memory, since streams keep that to themselves.
bool memory_was_short() noexcept;

}  // namespace elamin
