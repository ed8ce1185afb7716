#pragma once
/** @file RunReplay.hpp
 * ./cloth --replay FILE */
#include <string>

namespace lab {

struct Options;

/** Run the recording o.replay again, without a window, and write what @a o asks
 * for: the cloth at its end, a picture of that, a film, the recording.
 * @return the exit status: 0, 3 if it ends with a failure, 128 + a signal
 * Throws InputError, SceneFileError; std::runtime_error "FILE: why" */
int run_replay(const Options& o);

}  // namespace lab
