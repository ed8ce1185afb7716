/** @file 7.2.program.cpp
 * How far the cloth, whose points the grader moves at random, has fallen at
 * some times: about, as some programs have drag and some have not. */
#include "asked.hpp"

ASKED("7.2.program", program_asked) {
#ifdef KIT_HAS_MAIN
  for (double z : watched->at_150_ms) answer("heights at 0.15 s", z, 0.01);
  for (double z : watched->at_220_ms) answer("heights at 0.22 s", z, 0.03);
  answer("torn", watched->torn);
#endif
}
