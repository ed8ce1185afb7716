#include "lab/stepping/Changes.hpp"

#include "CME212/Util.hpp"
#include "lab/scenes/KeyValues.hpp"
#include "lab/scenes/Words.hpp"
#include "lab/stepping/Scene.hpp"

namespace lab {

namespace {

double size_of(double a) { return a; }
double size_of(const Gravity& a) { return a.size(); }

/** Add a request that sets a member of the model to what @a read reads. */
template <typename T>
void sets(Requests<Scene>& table, std::string_view name, T (*read)(Line&),
          T& (*member)(Model&)) {
  const auto run = [=](Line& in, Scene* scene) {
    const T a = read(in);
    in.end();
    if (!scene) return;
    Model m = scene->model();
    member(m) = a, scene->change_forces(m);
  };
  table.all.push_back({name, Requests<Scene>::override, run,
                       [=](Model& m) { return size_of(member(m)); }});
}

Requests<Scene> make_table() {
  Requests<Scene> table;
  constexpr auto plain = Requests<Scene>::plain;
  // From now on by this method; the step stays.
  table.on("method", plain,
           [](Scene& s, const MethodEntry* m) { s.take_method(*m); });
  // K [N/m], or the modulus of a scene that has one; rest lengths stay.
  sets<double>(
      table, "stiffness",
      [](Line& in) { return in.number("0 N/m or more", 0.); },
      [](Model& m) -> double& {
        return m.material.modulus ? *m.material.modulus : m.stiffness;
      });
  // c of each node [kg/s]; or by area [kg/(s m^2)], if the scene has that.
  sets<double>(
      table, "drag", [](Line& in) { return in.number("0 or more", 0.); },
      [](Model& m) -> double& {
        return m.material.drag ? *m.material.drag : m.damping;
      });
  // A number, which acts down, or a vector [m/s^2]
  sets<Gravity>(table, "gravity", read_gravity,
                [](Model& m) -> Gravity& { return m.gravity; });
  // Remove edges, each by its ends.
  table.on("cut", plain, [](Scene& s, std::vector<Ends> edges) {
    for (Ends& e : edges) e = {s.id_of(e[0]), s.id_of(e[1])};
    s.cut(edges);
  });
  // Hold a node where it is, at rest; let it go, whatever pin holds it.
  table.on("pin", plain, [](Scene& s, unsigned node) { s.pin(s.id_of(node)); });
  table.on("unpin", plain,
           [](Scene& s, unsigned node) { s.unpin(s.id_of(node)); });
  return table;
}

}  // namespace

const Requests<Scene>& scene_requests() {
  static const Requests<Scene> table = make_table();
  return table;
}

std::vector<Change> read_changes(const std::vector<std::string>& lines) {
  std::vector<Change> all;
  for (const std::string& line : lines) {
    Line in(line);
    const double time = in.number("a time [s]", 0.);
    if (!all.empty() && time < all.back().time)
      in.fail("comes after " + CME212::short_text(all.back().time) + " s");
    all.push_back({time, std::string(in.rest())});
    std::string error = in.error();
    if (error.empty()) error = scene_requests().error_in(all.back().request);
    if (!error.empty()) throw SceneError("at", in_quotes(line) + ": " + error);
  }
  return all;
}

}  // namespace lab
