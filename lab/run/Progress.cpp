#include "lab/run/Progress.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>

#include <unistd.h>

namespace lab {

Progress::Progress(bool quiet)
    : on_(!quiet), terminal_(isatty(STDERR_FILENO)) {}

bool Progress::due() {
  if (!on_ || seconds() < next_) return false;
  next_ = seconds() + (terminal_ ? 0.1 : 5.0);
  return true;
}

void Progress::show(const std::string& text, double done) {
  if (!on_ || (!terminal_ && text == text_)) return;
  text_ = text;
  std::ostringstream line;
  if (terminal_) {
    const auto filled = std::size_t(20 * std::clamp(done, 0.0, 1.0));
    line << "\r[" << std::string(filled, '#') << std::string(20 - filled, ' ')
         << "] ";
  }
  line << text;
  if (done > 1e-3)  // before that, who knows
    line << ", "
         << CME212::short_text(
                std::ceil(seconds() * std::max(0., 1 / done - 1)))
         << " s left";
  std::string all = line.str();
  if (terminal_) all.resize(79, ' ');  // with the \r, so it never wraps
  std::cerr << all << (terminal_ ? "" : "\n") << std::flush;
}

void Progress::end() const {
  if (on_ && terminal_) std::cerr << '\r' << std::string(78, ' ') << '\r';
}

}  // namespace lab
