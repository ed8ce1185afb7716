/** @file kit.cpp
 * What tests need that depends on no submission: it is compiled once. */
#include <csetjmp>
#include <csignal>

#include "check.hpp"
#include "model.hpp"

template class std::vector<int>;
template class std::vector<kit::Ends>;
template class std::vector<kit::Seen>;

namespace kit {

// ---------------------------------------------------------------------- Words

static std::string digits(double a) {
  if (a != a) return "nan";
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, a).ptr};
}

Word::Word(const char* a) : text(a) {}
Word::Word(const std::string& a) : text(a) {}
Word::Word(char a) : text(1, a) {}
Word::Word(bool a) : text(a ? "true" : "false") {}
Word::Word(int a) : text(std::to_string(a)) {}
Word::Word(unsigned a) : text(std::to_string(a)) {}
Word::Word(long a) : text(std::to_string(a)) {}
Word::Word(unsigned long a) : text(std::to_string(a)) {}
Word::Word(long long a) : text(std::to_string(a)) {}
Word::Word(unsigned long long a) : text(std::to_string(a)) {}
Word::Word(double a) : text(digits(a)) {}
Word::Word(const Point& a)
    : text('(' + digits(a.x) + ", " + digits(a.y) + ", " + digits(a.z) + ')') {}
Word::Word(const Word& a) = default;
Word::~Word() = default;

std::string join(std::initializer_list<Word> words) {
  std::string all;
  for (const Word& word : words) all += word.text;
  return all;
}

// --------------------------------------------------------------------- Checks

Point drawn_near(const Point& p, double far) {
  Point near;
  for (int k : {0, 1, 2}) near[k] = drawn(p[k], p[k] - far, p[k] + far);
  return near;
}
Point answer(const std::string& what, const Point& p, double tolerance) {
  for (double a : {p.x, p.y, p.z}) answer(what, a, tolerance);
  return p;
}

bool near(double a, double b, double tolerance) {
  return std::abs(a - b) <= tolerance;  // false of NaN
}
bool near(const Point& a, const Point& b, double tolerance) {
  return near(a.x, b.x, tolerance) && near(a.y, b.y, tolerance) &&
         near(a.z, b.z, tolerance);
}

double size(double a) { return std::max(1., std::abs(a)); }
double size(const Point& a) {
  return std::max({size(a.x), size(a.y), size(a.z)});
}

void check(bool holds, const char* what) {
  checked();
  if (!holds) miss(what, "");
}
void check(bool holds, const std::string& what) { check(holds, what.c_str()); }
void differ(const Word& what, const Word& expected, const Word& got) {
  miss(join({what, " == ", expected}), got.text);
}
void differ(const Word& what, const Word& expected, double tolerance,
            const Word& got) {
  miss(join({what, " == ", expected, " (within ", tolerance, ")"}), got.text);
}

// ---------------------------------------------------------------------- Model

std::string name(int v) {
  return v < 0 ? "no node that was added" : 'n' + std::to_string(v);
}
Point place(int v) { return Point(v, 2 * v, -v); }
int node_named(const Point& p) {
  if (!(p.x >= 0 && p.x < 1e6)) return -1;
  const int v = int(p.x);
  return p == place(v) ? v : -1;
}
int value_of_node(int v) { return 1000 + v; }

Ends::Ends(int v, int w) : a(std::min(v, w)), b(std::max(v, w)) {}
bool Ends::operator==(const Ends& e) const { return a == e.a && b == e.b; }
bool Ends::has(int v) const { return a == v || b == v; }
double Ends::value() const { return 100.5 * a + b; }
std::string name(Ends e) { return name(e.a) + '-' + name(e.b); }

Model::Model() = default;
Model::Model(const Model& m) = default;
Model& Model::operator=(const Model& m) = default;
Model::~Model() = default;
bool Model::has(int v) const {
  return std::find(nodes.begin(), nodes.end(), v) != nodes.end();
}
bool Model::has(Ends e) const {
  return std::find(edges.begin(), edges.end(), e) != edges.end();
}
std::vector<Ends> Model::edges_at(int v) const {
  std::vector<Ends> here;
  for (Ends e : edges)
    if (e.has(v)) here.push_back(e);
  return here;
}
void Model::add(int v) { nodes.push_back(v); }
void Model::add(Ends e) {
  if (!has(e)) edges.push_back(e);
}
void Model::remove(int v) {
  std::erase(nodes, v);
  std::erase_if(edges, [v](Ends e) { return e.has(v); });
}
void Model::remove(Ends e) { std::erase(edges, e); }

Model nodes(int n) {
  Model m;
  for (int v = 0; v < n; ++v) m.add(v);
  return m;
}
Model ring(int n) {
  Model m = nodes(n);
  for (int v = 0; v < n; ++v) m.add(Ends(v, (v + 1) % n));
  return m;
}
Model wheel(int n) {
  Model m = nodes(n);
  for (int v = 1; v < n; ++v) {
    m.add(Ends(0, v));
    m.add(Ends(v, v % (n - 1) + 1));
  }
  return m;
}
Model complete(int n) {
  Model m = nodes(n);
  for (int v = 0; v < n; ++v)
    for (int w = 0; w < v; ++w) m.add(Ends(w, v));
  return m;
}
Model grid(int n) {
  Model m = nodes(n * n);
  for (int v = 0; v < n * n; ++v) {
    if (v % n != n - 1) m.add(Ends(v, v + 1));
    if (v < n * (n - 1)) m.add(Ends(v, v + n));
  }
  return m;
}
static std::string count(std::size_t n, const char* what) {
  return words(n, " ", what, n == 1 ? "" : "s");
}
std::string description(const Model& m) {
  return words("a graph of ", count(m.nodes.size(), "node"), " and ",
               count(m.edges.size(), "edge"));
}

Dice drawn_dice(std::uint32_t usual) {
  return {std::uint32_t(drawn(usual, 0, 4294967296.))};
}
int Dice::operator()(std::size_t n) {
  state = state * 1664525u + 1013904223u;
  return int((state >> 8) % n);
}

// ----------------------------------------------------------- What is wrong

View::~View() = default;

namespace {

/** As fail() takes it; nothing if `expected` is empty. */
struct Fault {
  std::string expected, got;
};

/** The fault that @a seen, met in @a range, is not each of @a expected once. */
template <typename T>
Fault not_once(const std::vector<T>& seen, const std::vector<T>& expected,
               const std::string& range) {
  auto times = [&seen](const T& x) {
    return std::count(seen.begin(), seen.end(), x);
  };
  auto wrong = [&](const T& x, const char* expected_times) -> Fault {
    const long n = times(x);
    return {words(range, " to reach ", name(x), " ", expected_times),
            n == 0   ? "never"
            : n == 1 ? "once"
            : n == 2 ? "twice"
                     : words(n, " times")};
  };
  for (const T& x : expected)
    if (times(x) != 1) return wrong(x, "once");
  for (const T& x : seen)
    if (std::find(expected.begin(), expected.end(), x) == expected.end())
      return wrong(x, "never");
  return {};
}
std::vector<Ends> ends(const std::vector<Seen>& seen) {
  std::vector<Ends> all;
  for (const Seen& e : seen) all.push_back(e.ends);
  return all;
}
Fault after_walk(View::Walk walk, const std::string& range, std::size_t steps) {
  if (walk == View::endless)
    return {words(range, " to end after ", count(steps, "step")), "more"};
  if (walk == View::absent) return {range + " to compile", "an error"};
  return {};
}
Fault unequal(const std::string& what, const Word& expected, const Word& got) {
  return {join({what, " == ", expected}), got.text};
}
Fault missing(const std::string& member) {
  return {member + " to compile", "an error"};
}

using Number = View::Number;
/** Numbers that a look has read of the graph: for an answer. */
std::vector<Number> noted;
void note(Number v, double w) { noted.push_back(v * 10000 + std::llround(w)); }
void note(const Seen& e, bool value) {
  note(e.ends.a * 10000ll + e.ends.b, value ? 2 * e.value.value_or(0) : 0);
}
/** A number that stands for all of them, whatever their order. */
double digest() {
  std::sort(noted.begin(), noted.end());
  std::uint64_t hash = noted.size();
  for (Number x : noted) {
    hash = (hash ^ std::uint64_t(x)) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 29;
  }
  return double(hash >> 20);
}
/** The name of its answer. */
const char* title(Aspect what) {
  const char* names[] = {
      "nodes by index?",         "nodes with values?",
      "nodes in a loop?",        "edges in number?",
      "edges by index?",         "edges with values?",
      "edges in a loop?",        "edges at nodes?",
      "edges from nodes?",       "edges with values at nodes?",
      "edges counted at nodes?", "edges by has_edge?"};
  return names[std::countr_zero(unsigned(what))];
}

Fault look_at_indices(View& g, const Model& m) {
  std::vector<int> seen;
  for (std::size_t i = 0; i < m.nodes.size(); ++i) {
    if (g.index(i) != View::Number(i))
      return unequal(words("node(", i, ").index()"), i, g.index(i));
    const Point at = g.position(i);
    if (!m.has(node_named(at)))
      return {words("node(", i, ").position() to be that of a node added and ",
                    "not removed"),
              text(at)};
    seen.push_back(node_named(at));
    note(seen.back(), 0);
  }
  return not_once(seen, m.nodes, "node(i), of all i,");
}

Fault look_at_node_values(View& g, const Model& m) {
  for (std::size_t i = 0; i < m.nodes.size(); ++i) {
    const int v = node_named(g.position(i));
    const auto value = g.node_value(i);
    if (!value) return missing("value() of a node");
    note(v, *value);
    if (*value != value_of_node(v))
      return unequal(words("the value of ", name(v)), value_of_node(v), *value);
  }
  return {};
}

Fault look_at_edge_indices(View& g, const Model& m, bool values) {
  std::vector<Seen> seen;
  for (std::size_t i = 0; i < m.edges.size(); ++i) {
    const auto e = g.edge(i);
    if (!e) return missing("edge(i)");
    if (values && !e->value) return missing("value() of an edge");
    if (values && *e->value != e->ends.value())
      return unequal(words("edge(", i, ").value(), of ", name(e->ends), ","),
                     e->ends.value(), *e->value);
    seen.push_back(*e);
    note(*e, values);
  }
  return not_once(ends(seen), m.edges, "edge(i), of all i,");
}

Fault look_at_edges_at(View& g, const Model& m, std::size_t i, Aspect what) {
  const int v = node_named(g.position(i));
  const auto expected = m.edges_at(v);
  if (what == degrees) {
    const auto degree = g.degree(i);
    if (!degree) return missing("degree() of a node");
    note(v, double(*degree));
    if (*degree != View::Number(expected.size()))
      return unequal(words("degree() of ", name(v)), expected.size(), *degree);
    return {};
  }
  const auto range =
      words("a loop from edge_begin() to edge_end() of ", name(v));
  std::vector<Seen> seen;
  Fault fault =
      after_walk(g.edges_at(i, expected.size(), seen), range, expected.size());
  if (!fault.expected.empty()) return fault;
  for (const Seen& e : seen)
    if (what == seen_from)
      note(v, e.first);
    else
      note(e, what == incident_values);
  if (what == incident_loop) return not_once(ends(seen), expected, range);
  for (const Seen& e : seen) {
    if (what == seen_from && e.first != v)
      return {words("node1() of each edge at ", name(v), " to be ", name(v)),
              name(e.first)};
    if (what == incident_values && !e.value)
      return missing("value() of an edge");
    if (what == incident_values && *e.value != e.ends.value())
      return unequal(
          words("the value of ", name(e.ends), ", seen from ", name(v), ","),
          e.ends.value(), *e.value);
  }
  return {};
}

Fault look_at_adjacency(View& g, const Model& m) {
  for (std::size_t i = 0; i < m.nodes.size(); ++i)
    for (std::size_t j = 0; j < m.nodes.size(); ++j) {
      if (i == j) continue;  // left open
      const int v = node_named(g.position(i)), w = node_named(g.position(j));
      const bool expected = m.has(Ends(v, w)), there = g.has_edge(i, j);
      if (there) note(v, w);
      if (there != expected)
        return unequal(words("has_edge(", name(v), ", ", name(w), ")"),
                       expected, there);
    }
  return {};
}

/** Look at one aspect. No member is called of which another aspect says how
 * often it may be: node(i) at most num_nodes() times, and so on. */
Fault look(View& g, const Model& m, Aspect what) {
  const std::size_t size = m.nodes.size(), edges = m.edges.size();
  if (g.num_nodes() != View::Number(size))
    return unequal("num_nodes()", size, g.num_nodes());
  if ((what == edge_count || what == edge_indices || what == edge_values) &&
      g.num_edges() != View::Number(edges))
    return unequal("num_edges()", edges, g.num_edges());
  Fault fault;
  if (what == edge_count) note(g.num_edges(), 0);
  switch (what) {
    case by_index:
      return look_at_indices(g, m);
    case node_values:
      return look_at_node_values(g, m);
    case node_loop: {
      const std::string range = "a loop from node_begin() to node_end()";
      std::vector<int> seen;
      fault = after_walk(g.nodes(size, seen), range, size);
      for (int v : seen) note(v, 0);
      return fault.expected.empty() ? not_once(seen, m.nodes, range) : fault;
    }
    case edge_indices:
    case edge_values:
      return look_at_edge_indices(g, m, what == edge_values);
    case edge_loop: {
      if (edges == 0) return {};  // 1.iterators looks at it, no other task
      const std::string range = "a loop from edge_begin() to edge_end()";
      std::vector<Seen> seen;
      fault = after_walk(g.edges(edges, seen), range, edges);
      for (const Seen& e : seen) note(e, false);
      return fault.expected.empty() ? not_once(ends(seen), m.edges, range)
                                    : fault;
    }
    case incident_loop:
    case seen_from:
    case incident_values:
    case degrees:
      for (std::size_t i = 0; i < size && fault.expected.empty(); ++i)
        fault = look_at_edges_at(g, m, i, what);
      return fault;
    case adjacency:
      return look_at_adjacency(g, m);
    default:
      return fault;
  }
}

sigjmp_buf before_look;
extern "C" void leave_look(int) { siglongjmp(before_look, 1); }

/** Does this aspect work? One that throws or aborts does not, and only a test
 * that needs it is to end by it. */
bool looks_well(View& g, const Model& m, Aspect what) {
  struct Handler {
    void (*const old)(int) = std::signal(SIGABRT, leave_look);
    ~Handler() { std::signal(SIGABRT, old); }
  } handler;
  volatile bool well = false;
  if (sigsetjmp(before_look, 1) == 0) {
    try {
      well = look(g, m, what).expected.empty();
    } catch (const Failure&) {
      throw;
    } catch (...) {
    }
  }
  return well;
}

}  // namespace

Beside::Beside(const Model& shape) : m(shape) {}
Beside::~Beside() = default;
void Beside::begin(View& view) {
  view_ = &view;
  for (unsigned a = 1; a < all_aspects; a *= 2)
    if (probes(a) && looks_well(view, m, Aspect(a))) works |= a;
  probes(0);
  // One that is not the same from both ends is not to be relied on.
  if (!(works & incident_values)) works &= ~unsigned(edge_values);
}
unsigned Beside::still_works() {
  unsigned now = 0;
  for (unsigned a = 1; a < all_aspects; a *= 2)
    if (works & a && looks_well(*view_, m, Aspect(a))) now |= a;
  return now;
}
void Beside::hold() { hold(works | by_index); }
void Beside::hold(unsigned aspects) {
  checked();
  for (unsigned a = 1; a < all_aspects; a *= 2) {
    if (!(aspects & a)) continue;
    noted.clear();
    const Fault fault = look(*view_, m, Aspect(a));
    if (!fault.expected.empty()) miss(fault.expected, fault.got);
    if (tells) answer(title(Aspect(a)), digest());
  }
}
std::optional<std::size_t> Beside::find(int v) {
  const auto there = view_->num_nodes();
  for (std::size_t i = 0; i < m.nodes.size() && View::Number(i) < there; ++i)
    if (node_named(view_->position(i)) == v) return i;
  return {};
}
std::size_t Beside::index_of(int v) {
  if (auto i = find(v)) return *i;
  fail(words("node(i), of all i, to reach ", name(v), " once"), "never");
}
std::size_t Beside::index_of(Ends e) {
  const auto there = view_->num_edges();
  for (std::size_t i = 0; i < m.edges.size() && View::Number(i) < there; ++i)
    if (auto seen = view_->edge(i); seen && seen->ends == e) return i;
  fail(words("edge(i), of all i, to reach ", name(e), " once"), "never");
}

}  // namespace kit
