/** @file law.cpp
 * The nets of 8.my_step.cpp, in a process that no submission shares: it alone
 * knows the springs, and counts the forces that it is asked for. From stdin it
 * reads the grader's secret, then each Question; replies go to stdout. Forces
 * beyond Net::forces on each node are zero. At the end it writes to stderr how
 * many it was asked for, on each node of net 0. */
#include <unistd.h>

#include "../tests/trial.hpp"
#include "law.hpp"

namespace kit {
void checked() {}
void fail(std::string, std::string) { std::abort(); }
bool probes(unsigned) { return false; }
double drawn(double usual, double, double) { return usual; }
void answer(const std::string&, double, double) {}
}  // namespace kit

int main() {
  using kit::Net, kit::Question;
  unsigned char word[kit::Draw::secret];
  if (read(0, word, sizeof word) != sizeof word) return 2;
  kit::Draw draw(word, "far_nets");
  const kit::Trial nets[] = {kit::Trial(std::ref(draw)),
                             kit::Trial(std::ref(draw))};
  long asked[3] = {};  // the third run is of net 0, too
  Question q;
  while (read(0, &q, sizeof q) == sizeof q) {
    if (q.net < 0 || q.net > 2 || q.node < 0 || q.node >= Net::size) return 2;
    const kit::Trial& net = nets[q.net % 2];
    Point reply;
    switch (q.what) {
      case Question::body:
        reply = Point(net.start.m[q.node], net.begin, 0);
        break;
      case Question::start:
        reply = net.start.x[q.node];
        break;
      case Question::pin:
        reply = net.pin(q.node, q.t);
        break;
      case Question::force:
        if (++asked[q.net] <= long(Net::forces) * Net::size)
          reply = net.force(q.node, q.t, [&q](int i) { return q.x[i]; });
    }
    if (write(1, &reply, sizeof reply) != sizeof reply) return 2;
  }
  std::fprintf(stderr, "%.17g\n", double(asked[0]) / Net::size);
}
