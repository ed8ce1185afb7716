#pragma once
/** @file Requests.hpp
 * Requests: a table of what a line of text asks of something that runs. */
#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "CME212/PageData.hpp"
#include "lab/scenes/Line.hpp"
#include "lab/scenes/Words.hpp"

namespace lab {

using Ends = std::array<unsigned, 2>;  // an edge, by the numbers of its nodes

// read(in, value): the next words as a value of a request.
inline void read(Line& in, unsigned& node) {
  node = in.number<unsigned>("the number of a node");
}
inline void read(Line& in, Point& p) {
  for (int k = 0; k < 3; ++k) p[k] = in.number("three coordinates [m]");
}
inline void read(Line& in, Ends& edge) { read(in, edge[0]), read(in, edge[1]); }
inline void read(Line& in, CME212::Ray& r) {
  read(in, r.near), read(in, r.far);
}
inline void read(Line& in, const MethodEntry*& method) {
  std::string hint;
  const std::string_view name = in.word("a method");
  method = method_named(name, hint);
  if (!method) in.fail(mesh_detail::quoted(name) + " is not a method" + hint);
}
template <typename T>
void read(Line& in, std::vector<T>& all) {
  while (!in.at_end()) read(in, all.emplace_back());
}

/** A line of text that starts with a name asks something of a @a Target. */
template <typename Target>
struct Requests {
  enum Kind {
    plain,
    override,  // replaces the last one, if that has the same name
    expand,    // is the requests that it makes
  };
  struct Request {
    std::string_view name;
    Kind kind;
    /** Read what follows the name; if the target is not null, change it.
     * @pre null, or the line makes sense */
    std::function<void(Line&, Target*)> run;
    std::function<double(Model&)> parameter = {};  // that it sets, if one
  };
  std::vector<Request> all;

  /** The one that the next word of @a in names; null if @a in fails. */
  const Request* find(Line& in) const {
    return in.one_of("a request", all, &Request::name);
  }
  /** The error in a request; "" if there is none. */
  std::string error_in(std::string_view request) const {
    Line in(request);
    if (const auto* found = find(in)) found->run(in, nullptr);
    return in.error();
  }
  /** A request whose values are of the types that @a apply takes. */
  void on(std::string_view name, Kind kind, auto apply) {
    add(name, kind, std::function(apply));
  }
  template <typename... Values>
  void add(std::string_view name, Kind kind,
           const std::function<void(Target&, Values...)>& apply) {
    const auto run = [apply](Line& in, Target* target) {
      std::tuple<Values...> values;
      std::apply([&](auto&... v) { (read(in, v), ...); }, values);
      in.end();
      if (target) std::apply([&](auto&... v) { apply(*target, v...); }, values);
    };
    all.push_back({name, kind, run});
  }
};

}  // namespace lab
