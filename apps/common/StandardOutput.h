#pragma once
#include <iosfwd>

/** What a program says of its own accord: the standard output, or nothing after beQuiet(). What it
 * was asked for goes to std::cout. */
std::ostream& notes();
/** The same, of what most do not want to know: nothing but after beVerbose(). */
std::ostream& details();
void beQuiet();
void beVerbose();

/** Gives the standard streams that are closed a descriptor that takes nothing: otherwise the first
 * file that is opened would get what is printed. */
void openStandardStreams();

/** \return whether all that was printed was taken */
bool flushStandardOutput();
