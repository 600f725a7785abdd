#pragma once
#include <iosfwd>

/** What a program says of its own accord: the standard output, or nothing after beQuiet(). What it
 * was asked for goes to std::cout. */
std::ostream& notes();
/** The same, of what most do not want to know: nothing but after beVerbose(). */
std::ostream& details();
void beQuiet();
void beVerbose();

/** On a terminal: what notes() says next replaces the line that was begun. */
void replaceLine();

/** Gives the standard streams that are closed a descriptor that takes nothing: otherwise the first
 * file that is opened would get what is printed. From then on std::cout and std::cerr show control
 * characters, which names in files may have, as printable() does; lines and tabs stay. */
void openStandardStreams();

/** \return whether all that was printed was taken */
bool flushStandardOutput();
