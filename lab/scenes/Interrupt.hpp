#pragma once
/** @file Interrupt.hpp
 * SIGINT (Ctrl-C), SIGTERM and SIGHUP end a program cleanly. */

namespace lab {

/** From now on the first signal of each kind only makes interrupted() true; the
 * second one of a kind ends the program at once. Signals that are ignored, as
 * by nohup, stay ignored. System calls are resumed. */
void catch_interrupts();

/** The number of the signal that came last, SIGINT, SIGTERM or SIGHUP; 0 if
 * none came. Any thread may ask. */
int interrupted();
/** As if none had come: for a program that goes on. */
void forget_interrupts();
/** Its name; "" if none came. */
const char* name_of_interrupt();

/** Thrown to end a computation whose results are not kept. Not derived from
 * std::exception, so that it is not caught as a failure. */
struct Interrupted {};
/** Throws Interrupted if a signal came. */
void end_if_interrupted();

}  // namespace lab
