/** @file model.hpp
 * The model of a graph: the data that it should hold; the shapes that tests
 * start from; and the words for a difference. Defined in kit.cpp. */
#ifndef KIT_MODEL_HPP
#define KIT_MODEL_HPP
#include "check.hpp"

namespace kit {

/** "n3" */
std::string name(int v);
/** Where node v stands, which no other node does. */
Point place(int v);
/** The node that stands at @a p, or -1. */
int node_named(const Point& p);
int value_of_node(int v);

/** An edge by its ends, the lesser first. */
struct Ends {
  int a = 0, b = 0;
  Ends() = default;
  Ends(int v, int w);
  bool operator==(const Ends& e) const;
  bool has(int v) const;
  double value() const;
};
/** "n3-n4" */
std::string name(Ends e);

struct Model {
  std::vector<int> nodes;
  std::vector<Ends> edges;

  Model();
  Model(const Model& m);
  Model& operator=(const Model& m);
  ~Model();
  bool has(int v) const;
  bool has(Ends e) const;
  std::vector<Ends> edges_at(int v) const;
  void add(int v);
  void add(Ends e);
  void remove(int v);
  void remove(Ends e);
};

// Shapes: the nodes n0, n1, ... and some edges.
Model nodes(int n);
Model ring(int n);
/** The hub n0 and a ring of the others. */
Model wheel(int n);
/** All joined. */
Model complete(int n);
/** Squares, n nodes on a side. */
Model grid(int n);
/** "a graph of 5 nodes and 8 edges" */
std::string description(const Model& m);

/** Random numbers: the same in every run and on every machine. */
struct Dice {
  std::uint32_t state;
  /** In [0, n). */
  int operator()(std::size_t n);
};
/** Of this seed, or in the grader's second run of another. */
Dice drawn_dice(std::uint32_t usual);

/** An edge as a loop or edge(i) gives it. */
struct Seen {
  Ends ends;
  int first = 0;  // node1()
  std::optional<double> value;
};

/** What can be read of a graph, of any type: graph.hpp defines it for the
 * submission's. What is empty or `absent` is no member that compiles. */
struct View {
  enum Walk { ended, endless, absent };
  using Number = long long;

  virtual ~View();
  virtual Number num_nodes() = 0;
  virtual Number num_edges() = 0;
  virtual Number index(std::size_t i) = 0;
  virtual Point position(std::size_t i) = 0;
  virtual std::optional<double> node_value(std::size_t i) = 0;
  virtual std::optional<Number> degree(std::size_t i) = 0;
  virtual bool has_edge(std::size_t i, std::size_t j) = 0;
  virtual std::optional<Seen> edge(std::size_t i) = 0;
  /** From begin to end, but no more than @a limit steps. */
  virtual Walk nodes(std::size_t limit, std::vector<int>& seen) = 0;
  virtual Walk edges(std::size_t limit, std::vector<Seen>& seen) = 0;
  virtual Walk edges_at(std::size_t i, std::size_t limit,
                        std::vector<Seen>& seen) = 0;
};

/** What can be looked at by itself. */
enum Aspect : unsigned {
  by_index = 1,         // num_nodes(), node(i), index(), position()
  node_values = 2,      //
  node_loop = 4,        // node_begin(), node_end()
  edge_count = 8,       // num_edges()
  edge_indices = 16,    // edge(i)
  edge_values = 32,     // of edge(i)
  edge_loop = 64,       // edge_begin(), edge_end()
  incident_loop = 128,  // edge_begin(), edge_end() of a node
  seen_from = 256,      // node1() there
  incident_values = 512,
  degrees = 1024,
  adjacency = 2048,  // has_edge()
  all_aspects = 4095,
  dead_edges = 4096  // what a handle of a removed edge does
};

/** A graph under test and what it should hold.
 *
 * A test of a later section starts from what works in this graph: an aspect
 * that is wrong before the test does anything is the fault of another task, and
 * is not looked at. */
struct Beside {
  Model m;
  unsigned works = 0;
  bool tells = false;  ///< hold() answers what the graph holds, too

  explicit Beside(const Model& shape);
  Beside(const Beside&) = delete;
  ~Beside();
  /** Look at all that works before the test does anything. */
  void begin(View& view);
  /** The graph is as the model is, or the test fails. */
  void hold();
  void hold(unsigned aspects);
  /** The aspects that work now. */
  unsigned still_works();
  /** Where node(i) is this node. */
  std::optional<std::size_t> find(int v);
  /** Where node(i) or edge(i) is this node or edge, or the test fails. */
  std::size_t index_of(int v);
  std::size_t index_of(Ends e);

 private:
  View* view_ = nullptr;
};

}  // namespace kit

extern template class std::vector<int>;
extern template class std::vector<kit::Ends>;
extern template class std::vector<kit::Seen>;
#endif
