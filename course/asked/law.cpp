/** @file law.cpp
 * The nets of 8.my_step.cpp, in a process that no submission shares: it alone
 * knows the springs, and counts the forces that it is asked for, of all nodes
 * at once: each question changes the process twice. From stdin it reads the
 * grader's secret, then each Question; replies go to stdout. Forces beyond
 * Net::forces on each node are zero. At the end it writes to stderr how often
 * it was asked for those of net 0. */
#include <unistd.h>

#include "../tests/trial.hpp"
#include "law.hpp"

namespace kit {
void checked() {}
void fail(std::string, std::string) { std::abort(); }
void miss(std::string, std::string) { std::abort(); }
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
    if (q.net < 0 || q.net > 2) return 2;
    const kit::Trial& net = nets[q.net % 2];
    kit::Reply reply;
    const bool is_spent =
        q.what == Question::force && ++asked[q.net] > Net::forces;
    for (int i = 0; i < Net::size && !is_spent; ++i) switch (q.what) {
        case Question::body:
          reply.of[i] = Point(net.start.m[i], net.begin, 0);
          break;
        case Question::start:
          reply.of[i] = net.start.x[i];
          break;
        case Question::pin:
          if (Net::is_pin(i)) reply.of[i] = net.pin(i, q.t);
          break;
        case Question::force:
          reply.of[i] = net.force(i, q.t, [&q](int k) { return q.x[k]; });
      }
    if (write(1, &reply, sizeof reply) != sizeof reply) return 2;
  }
  std::fprintf(stderr, "%ld\n", asked[0]);
}
