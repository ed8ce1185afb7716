#pragma once
/** @file Interrupt.hpp
 * SIGINT (Ctrl-C), SIGTERM and SIGHUP end a program in order. */

namespace lab {

/** From now on the first signal of each kind only makes interrupted() true; the
 * second one of a kind ends the program at once, as without this. Signals that
 * are ignored stay so, as by nohup. Calls of the system go on. */
void catch_interrupts();

/** The number of the signal that came last, SIGINT, SIGTERM or SIGHUP; 0 if
 * none came. Any thread may ask. */
int interrupted();
/** Its name; "" if none came. */
const char* name_of_interrupt();

/** What ends a computation that has nothing to keep. Not derived from
 * std::exception, so that nobody takes it for a computation that failed. */
struct Interrupted {};
/** Throws Interrupted if a signal came. */
void end_if_interrupted();

}  // namespace lab
