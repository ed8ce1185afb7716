/** @file film.hpp
 * Records what a program gives to the viewer of the tests, headless/CME212. */
#ifndef KIT_FILM_HPP
#define KIT_FILM_HPP
#include <condition_variable>

#include "prelude.hpp"
#include "values.hpp"

namespace kit {

/** All frames that a program gave to the viewer. */
struct Film {
  struct Body {
    Point x, v;
    double m = 0;
    bool has_v = false, has_m = false;
  };
  struct Spring {
    Point a, b;  // its ends
    double K = 0, L = 0;
    bool has_K = false, has_L = false;
  };

  int frames = 0;             ///< how often the nodes were drawn
  double t = 0;               ///< the latest label that is a number
  std::vector<Body> start;    ///< the nodes, drawn first
  std::vector<Spring> edges;  ///< the edges, drawn first
  std::vector<Body> bodies;   ///< the nodes, drawn last
  /** Says after each frame whether the test has seen enough; from then on
   * nothing is kept, and the window counts as closed. */
  std::function<bool(const Film&)> enough;

  bool ended = false;
  std::function<void()> look_again;  // at the values of the first edges
  std::mutex mutex;
  std::condition_variable news;
  std::thread::id main_thread = std::this_thread::get_id();
  int drawing = 0;  // threads that draw, without the main one
  bool drew = false;

  void end_of_frame() {
    if (++frames == 2 && look_again) look_again();
    ended = enough && enough(*this);
    if (ended) news.notify_all();
  }
};
inline std::unique_ptr<Film> the_film = std::make_unique<Film>();
inline Film& film() { return *the_film; }
/** For the next program; threads of the one before have ended. */
inline Film& new_film() { return *(the_film = std::make_unique<Film>()); }

/** Tells the film when a thread that draws comes to its end. */
struct DrawingThread {
  const bool apart = std::this_thread::get_id() != film().main_thread;
  DrawingThread() { count(1); }
  ~DrawingThread() { count(-1); }
  void count(int n) {
    if (!apart) return;
    std::lock_guard lock(film().mutex);
    film().drawing += n;
    film().drew = true;
    film().news.notify_all();
  }
};

template <typename N>
Film::Body body_of(N n) {
  Film::Body b;
  b.x = n.position();
  if constexpr (requires { n.value(); }) {
    auto& value = n.value();
    if constexpr (is_there<decltype(velocity_in(value))>)
      b.v = *velocity_in(value), b.has_v = true;
    if constexpr (is_there<decltype(mass_in(value))>)
      b.m = *mass_in(value), b.has_m = true;
  }
  return b;
}
template <typename E>
void read_spring(E e, Film::Spring& s) {
  if constexpr (requires { e.value(); }) {
    auto& value = e.value();
    if constexpr (is_there<decltype(K_in(value))>)
      s.K = double(*K_in(value)), s.has_K = true;
    if constexpr (is_there<decltype(L_in(value))>)
      s.L = double(*L_in(value)), s.has_L = true;
  }
}

/** Keep a frame: the nodes in a range. */
template <typename It>
void film_nodes(It it, It last) {
  thread_local DrawingThread thread;
  std::lock_guard lock(film().mutex);
  Film& f = film();
  if (f.ended) return;
  f.bodies.clear();
  for (; it != last; ++it) f.bodies.push_back(body_of(*it));
  if (f.frames == 0) f.start = f.bodies;
  // Some programs set the masses after they drew the first frame.
  if (f.frames == 1 && f.start.size() == f.bodies.size())
    for (std::size_t i = 0; i < f.start.size(); ++i)
      f.start[i].m = f.bodies[i].m;
  f.end_of_frame();
}
template <typename It>
void film_edges(It it, It last) {
  std::lock_guard lock(film().mutex);
  Film& f = film();
  if (f.ended || !f.edges.empty()) return;
  using Edge = std::decay_t<decltype(*it)>;
  auto edges = std::make_shared<std::vector<Edge>>();
  for (; it != last; ++it) {
    edges->push_back(*it);
    Film::Spring s;
    s.a = edges->back().node1().position();
    s.b = edges->back().node2().position();
    read_spring(edges->back(), s);
    f.edges.push_back(s);
  }
  const auto nodes = f.bodies.size();
  f.look_again = [&f, edges, nodes] {
    if (f.bodies.size() != nodes) return;  // some are gone already
    for (std::size_t i = 0; i < edges->size(); ++i)
      read_spring((*edges)[i], f.edges[i]);
  };
}

}  // namespace kit
#endif
