#include "lab/scenes/SceneFile.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "CME212/Mesh.hpp"
#include "lab/scenes/Fields.hpp"
#include "lab/scenes/MeshFile.hpp"
#include "lab/scenes/Nearest.hpp"
#include "lab/scenes/StoredScenes.hpp"

namespace lab {

// -------------------------------------------------------------------- Reading

Origins set_fields(Model& m, const std::string& file, const std::string& text,
                   const std::function<void()>& check,
                   const std::function<bool(const KeyValue&)>& other) {
  Origins origins{file, {}};
  auto use = [&](const KeyValue& found, std::size_t line) {
    const std::string& key = found.key;
    origins.line_of.emplace(key, line);
    if (!set_field(m, key, found.values) && !(other && other(found)))
      throw InputError(
          file, line,
          "unknown key " + printable(key) + key_instead_of(key, scene_keys()));
    if (key == "nodes") m.nodes = beside(file, m.nodes);
    if (key == "tets") m.tets = beside(file, m.tets);
    if (key == "net") m.net = beside(file, m.net);
  };
  try {
    each_key_value(text, file, use);
    for (const Field& f : fields_of(m))
      if (const std::string other_key(f.instead_of);
          origins.line_of.count(f.name) && origins.line_of.count(other_key))
        throw SceneError(f.name, "excludes --" + other_key);
    check();
  } catch (const InputError& e) {
    throw SceneFileError(e.what());
  } catch (const std::runtime_error& e) {
    throw SceneFileError(origins.of(e.what(), file + ": ") + e.what());
  }
  return origins;
}

std::string Origins::of(const std::string& message,
                        const std::string& otherwise) const {
  const auto dashes = message.find("--");
  if (dashes == std::string::npos) return otherwise;
  const auto name = dashes + 2;
  const auto end =
      message.find_first_not_of("abcdefghijklmnopqrstuvwxyz-", name);
  auto it = line_of.find(message.substr(name, end - name));
  if (it == line_of.end()) return otherwise;
  return file + ':' + std::to_string(it->second) + ": ";
}

std::string scene_text(const std::string& file) {
  try {
    return mesh_detail::read_file(file, "a scene file");
  } catch (const InputError& e) {
    throw SceneFileError(e.what());
  }
}
std::string scene_name(const std::string& file) {
  const std::string name = file.substr(file.rfind('/') + 1);
  const auto dot = name.rfind('.');
  return dot == 0 ? name : name.substr(0, dot);
}
std::string beside(const std::string& scene, const std::string& name) {
  if (name.empty() || name[0] == '/') return name;
  return scene.substr(0, scene.rfind('/') + 1) + name;
}

void check_has_cloth(const Model& m) {
  if (m.sheets.empty() && m.net.empty() && (m.nodes.empty() || m.tets.empty()))
    throw SceneError(m.nodes.empty() ? "nodes" : "tets",
                     "is missing: expected files NODES and TETS, --net or "
                     "--sheet");
}

namespace {

Model model_in(const std::string& file, const std::string& name,
               const std::string& text, bool may_be_open) {
  Model m;
  m.name = name;
  set_fields(m, file, text, [&] {
    m = checked(m);
    if (!may_be_open) check_has_cloth(m);
  });
  return m;
}

}  // namespace

Model load_model(const std::string& file) {
  return model_in(file, scene_name(file), scene_text(file), false);
}
Model load_open_model(const std::string& file) {
  return model_in(file, scene_name(file), scene_text(file), true);
}
Model StoredScene::model() const { return model_in(name, name, text, true); }

const StoredScene& stored_scene(std::string_view name) {
  const auto all = stored_scenes();
  const auto it = std::ranges::find(all, name, &StoredScene::name);
  if (it == all.end()) throw std::out_of_range("no scene " + std::string(name));
  return *it;
}

// ------------------------------------------------------------------- Printing

std::string to_scene_file(const Model& m,
                          const std::vector<std::string>& without) {
  Model copy = m;
  const auto all = fields_of(copy);
  std::string text;
  for (const Field& f : all) {
    const auto values = f.values();
    const auto replaces = [&](const Field& other) {
      return other.instead_of == f.name && !other.values().empty();
    };
    if (values.empty() || std::ranges::any_of(all, replaces) ||
        std::ranges::count(without, f.name) > 0)
      continue;
    text += std::string("# ") + f.help + '\n' + f.name + " = ";
    std::string list;
    for (const std::string& value : values) {
      if (!list.empty()) list += ", ";
      const std::string_view type = f.type();
      if ((type == "FLOAT" || type == "FLOAT|VECTOR") &&
          value.find_first_of("% ") == std::string::npos)
        list += value;
      else
        list += in_quotes(f.role == Role::mesh ? absolute(value) : value);
    }
    text += f.repeats() ? '[' + list + "]\n" : list + '\n';
  }
  return text;
}

std::vector<std::string> scene_keys() {
  std::vector<std::string> names;
  Model none;
  for (const Field& f : fields_of(none)) names.emplace_back(f.name);
  return names;
}

}  // namespace lab
