#include "drivers/storage/structure_kinds.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <utility>

#include "core/structure/kinds/beam.h"
#include "core/structure/kinds/cable.h"
#include "core/structure/kinds/frame2d.h"
#include "core/structure/kinds/matrices.h"
#include "core/structure/kinds/modes.h"
#include "core/structure/kinds/shear_storeys.h"
#include "core/structure/kinds/tower.h"
#include "drivers/storage/matrix_market.h"
#include "drivers/storage/structure_value.h"

namespace drivers {
namespace {

using core::structure::Connection;
using core::structure::Sight;
using core::structure::StructuralModel;
using Model = std::unique_ptr<StructuralModel>;

constexpr double kMost = 1e18;

// `rigid`, `free`, or a stiffness.
Connection connection(const StructureMap& map, const std::string& key, const char* fallback) {
  const std::string value = map.text_or(key, fallback);
  if (value == "rigid") return Connection::rigid();
  if (value == "free") return Connection::free();
  if (!parse_number(value)) map.refuse(key, "write rigid, free, or a stiffness (N/m; rotation: N m/rad)");
  return Connection::spring(map.number(key, 0.0, kMost));
}

double share(const StructureMap& map, const std::string& key) { return 0.01 * map.number_or(key, 0.0, 300.0, 0.0); }

std::vector<Sight> sights(const StructureMap& map, const Eigen::Vector3d& usual) {
  std::vector<Sight> out;
  for (const StructureMap& region : map.maps("regions")) {
    region.allow({"name", "at_m", "direction"});
    Sight sight;
    sight.channel = region.text("name");
    const auto at = region.numbers("at_m", -1e6, 1e6, 3);
    sight.at_m = {at[0], at[1], at[2]};
    sight.direction = usual;
    if (region.has("direction")) {
      const auto d = region.numbers("direction", -1e6, 1e6, 3);
      sight.direction = {d[0], d[1], d[2]};
      if (!(sight.direction.norm() > 1e-9))
        region.refuse("direction", "is zero; give the axis seen, such as [1, 0, 0]");
      sight.direction.normalize();
    }
    out.push_back(std::move(sight));
  }
  return out;
}

Model beam(const StructureMap& map) {
  map.allow({"kind", "stiffness", "modes", "frequency_sigma_percent", "shape_sigma", "temperature", "regions", "spans",
             "supports", "masses", "axial_n", "shear_n", "rotary_per_m_kgm", "spring_prior_percent",
             "part_prior_percent"});
  core::structure::Beam out;
  for (const StructureMap& span : map.maps("spans")) {
    span.allow({"length_m", "ei_nm2", "mass_per_m_kg", "parts"});
    out.spans.push_back({span.number("length_m", 1e-3, 1e5), span.number("ei_nm2", 1e-9, kMost),
                         span.number("mass_per_m_kg", 1e-9, 1e9), span.whole_or("parts", 1, 60, 1)});
  }
  for (const StructureMap& support : map.maps("supports")) {
    support.allow({"displacement", "rotation"});
    out.supports.push_back({connection(support, "displacement", "rigid"), connection(support, "rotation", "free")});
  }
  for (const StructureMap& mass : map.maps("masses")) {
    mass.allow({"at_m", "kg"});
    out.masses.push_back({mass.number("at_m", 0.0, 1e5), mass.number("kg", 0.0, 1e12)});
  }
  out.axial_n = map.number_or("axial_n", -1e15, 1e15, 0.0);
  if (map.has("shear_n")) out.shear_n = map.number("shear_n", 1e-6, kMost);
  out.rotary_per_m_kgm = map.number_or("rotary_per_m_kgm", 0.0, 1e12, 0.0);
  out.spring_prior = share(map, "spring_prior_percent"), out.part_prior = share(map, "part_prior_percent");
  return make_beam(out, sights(map, Eigen::Vector3d::UnitZ()));
}

Model tower(const StructureMap& map) {
  map.allow({"kind",
             "stiffness",
             "modes",
             "frequency_sigma_percent",
             "shape_sigma",
             "temperature",
             "regions",
             "height_m",
             "ei_nm2",
             "mass_per_m_kg",
             "diameter_ratio",
             "ei_power",
             "mass_power",
             "parts",
             "tip_mass_kg",
             "guys",
             "foot_displacement",
             "foot_rotation",
             "shear_n",
             "rotary_per_m_kgm",
             "gravity",
             "spring_prior_percent",
             "part_prior_percent"});
  core::structure::Tower out;
  out.height_m = map.number("height_m", 1e-3, 1e4);
  out.ei_nm2 = map.number("ei_nm2", 1e-9, kMost);
  out.mass_per_m_kg = map.number("mass_per_m_kg", 1e-9, 1e9);
  out.diameter_ratio = map.number_or("diameter_ratio", 0.02, 5.0, 1.0);
  out.ei_power = map.number_or("ei_power", 0.0, 6.0, 4.0), out.mass_power = map.number_or("mass_power", 0.0, 6.0, 2.0);
  out.parts = map.whole_or("parts", 1, 60, 1);
  out.tip_mass_kg = map.number_or("tip_mass_kg", 0.0, 1e12, 0.0);
  for (const StructureMap& guy : map.maps("guys")) {
    guy.allow({"at_m", "stiffness_n_per_m"});
    out.guys.push_back({guy.number("at_m", 1e-9, 1e4), guy.number("stiffness_n_per_m", 0.0, 1e15)});
  }
  out.foot_displacement = connection(map, "foot_displacement", "rigid");
  out.foot_rotation = connection(map, "foot_rotation", "rigid");
  if (map.has("shear_n")) out.shear_n = map.number("shear_n", 1e-6, kMost);
  out.rotary_per_m_kgm = map.number_or("rotary_per_m_kgm", 0.0, 1e12, 0.0);
  out.gravity = map.one_of("gravity", {"true", "false"}) == "true";
  out.spring_prior = share(map, "spring_prior_percent"), out.part_prior = share(map, "part_prior_percent");
  return make_tower(out, sights(map, Eigen::Vector3d::UnitX()));
}

Model cable(const StructureMap& map) {
  map.allow({"kind", "stiffness", "modes", "frequency_sigma_percent", "shape_sigma", "temperature", "regions",
             "length_m", "mass_per_m_kg", "tension_n", "tension_prior_percent", "ei_nm2", "ei_prior_percent", "ea_n",
             "slope_deg", "end_rotation"});
  core::structure::Cable out;
  out.length_m = map.number("length_m", 1e-2, 1e4), out.mass_per_m_kg = map.number("mass_per_m_kg", 1e-6, 1e6);
  out.tension_n = map.number("tension_n", 1e-6, 1e12);
  out.tension_prior = 0.01 * map.number_or("tension_prior_percent", 0.0, 1000.0, 30.0);
  out.ei_nm2 = map.number_or("ei_nm2", 0.0, 1e15, 0.0), out.ei_prior = share(map, "ei_prior_percent");
  out.ea_n = map.number_or("ea_n", 0.0, 1e15, 0.0), out.slope_deg = map.number_or("slope_deg", -90.0, 90.0, 0.0);
  out.end_rotation = connection(map, "end_rotation", "free");
  return make_cable(out, sights(map, Eigen::Vector3d::UnitZ()));
}

Model frame2d(const StructureMap& map) {
  map.allow({"kind", "stiffness", "modes", "frequency_sigma_percent", "shape_sigma", "temperature", "regions", "nodes",
             "members", "couplings", "spring_prior_percent", "part_prior_percent"});
  core::structure::Frame2d out;
  for (const StructureMap& node : map.maps("nodes")) {
    node.allow({"name", "at_m", "mass_kg", "x", "z", "rotation"});
    const auto at = node.numbers("at_m", -1e5, 1e5, 2);
    out.nodes.push_back({node.text("name"), at[0], at[1], node.number_or("mass_kg", 0.0, 1e12, 0.0),
                         connection(node, "x", "free"), connection(node, "z", "free"),
                         connection(node, "rotation", "free")});
  }
  for (const StructureMap& member : map.maps("members")) {
    member.allow({"name", "from", "to", "ei_nm2", "ea_n", "mass_per_m_kg", "shear_n", "axial_n", "group"});
    core::structure::Frame2d::Member one;
    one.from = member.text("from"), one.to = member.text("to");
    one.name = member.text_or("name", one.from + "-" + one.to), one.group = member.text_or("group", "");
    one.ei_nm2 = member.number("ei_nm2", 1e-9, kMost), one.ea_n = member.number("ea_n", 1e-9, kMost);
    one.mass_per_m_kg = member.number("mass_per_m_kg", 0.0, 1e9);
    if (member.has("shear_n")) one.shear_n = member.number("shear_n", 1e-6, kMost);
    one.axial_n = member.number_or("axial_n", -1e15, 1e15, 0.0);
    out.members.push_back(std::move(one));
  }
  for (const StructureMap& coupling : map.maps("couplings")) {
    coupling.allow({"from", "to", "stiffness_n_per_m"});
    out.couplings.push_back(
        {coupling.text("from"), coupling.text("to"), coupling.number_or("stiffness_n_per_m", 0.0, 1e15, 0.0)});
  }
  out.spring_prior = share(map, "spring_prior_percent"), out.part_prior = share(map, "part_prior_percent");
  return make_frame2d(out, sights(map, Eigen::Vector3d::UnitX()));
}

Model storeys(const StructureMap& map) {
  map.allow({"kind", "locate", "stiffness", "modes", "frequency_sigma_percent", "shape_sigma", "temperature", "regions",
             "masses", "stiffness_ratio", "part_prior_percent"});
  core::structure::ShearFrame out;
  out.mass = map.numbers("masses", 1e-6, 1e6, 0);
  if (out.mass.empty() || out.mass.size() > core::structure::kMaxStoreys)
    map.refuse("masses", fmt::format("1 .. {} storeys, lowest first", core::structure::kMaxStoreys));
  out.stiffness_per_s2 = map.has("stiffness_ratio") ? map.numbers("stiffness_ratio", 1e-6, 1e12, out.mass.size())
                                                    : std::vector<double>(out.mass.size(), 1.0);
  return make_shear_storeys(out, sights(map, Eigen::Vector3d::UnitX()), share(map, "part_prior_percent"));
}

Model matrices(const StructureMap& map, const std::filesystem::path& folder) {
  map.allow({"kind", "stiffness", "modes", "frequency_sigma_percent", "shape_sigma", "temperature", "k", "m", "groups",
             "regions"});
  const auto path = [&](const std::string& name) { return (folder / name).string(); };
  core::structure::MatrixStructure out;
  out.stiffness = read_matrix_market(path(map.text("k"))), out.mass = read_matrix_market(path(map.text("m")));
  for (const StructureMap& group : map.maps("groups")) {
    group.allow({"name", "k", "m", "prior_percent"});
    core::structure::MatrixStructure::Group one;
    one.name = group.text("name"), one.prior = share(group, "prior_percent");
    if (group.has("k")) one.stiffness = read_matrix_market(path(group.text("k")));
    if (group.has("m")) one.mass = read_matrix_market(path(group.text("m")));
    if (!group.has("k") && !group.has("m")) group.refuse("name a file k, m, or both");
    out.groups.push_back(std::move(one));
  }
  for (const StructureMap& region : map.maps("regions")) {
    region.allow({"name", "dofs", "weights"});
    core::structure::MatrixStructure::Seen seen;
    seen.channel = region.text("name");
    const auto dofs = region.numbers("dofs", 1.0, 1e9, 0);
    const auto weights =
        region.has("weights")
            ? region.numbers("weights", -1e6, 1e6, dofs.size())
            : std::vector<double>(dofs.size(), 1.0 / std::max<double>(1.0, static_cast<double>(dofs.size())));
    for (std::size_t i = 0; i < dofs.size(); ++i)
      seen.dofs.emplace_back(static_cast<std::size_t>(dofs[i]) - 1, weights[i]);
    out.seen.push_back(std::move(seen));
  }
  out.n_modes = map.whole_or("modes", 1, 40, 12);
  return make_matrices(out);
}

Model modes(const StructureMap& map) {
  map.allow({"kind", "stiffness", "modes", "frequency_sigma_percent", "shape_sigma", "temperature", "channels",
             "parameters", "table", "prior_percent"});
  core::structure::ModeTable out;
  out.channels = map.texts("channels"), out.parameters = map.texts("parameters");
  out.prior = share(map, "prior_percent");
  for (const StructureMap& mode : map.maps("table")) {
    mode.allow({"frequency_hz", "shape", "sensitivity"});
    core::structure::ModeTable::Mode one;
    one.frequency_hz = mode.number("frequency_hz", 1e-6, 1e9);
    if (mode.has("shape")) one.shape = mode.numbers("shape", -1e9, 1e9, out.channels.size());
    if (mode.has("sensitivity")) one.sensitivity = mode.numbers("sensitivity", -100.0, 100.0, out.parameters.size());
    one.sensitivity.resize(out.parameters.size(), 0.0);
    out.modes.push_back(std::move(one));
  }
  return make_modes(out);
}

Model model_of(const std::string& kind, const StructureMap& map, const std::string& file) {
  if (kind == "beam") return beam(map);
  if (kind == "tower") return tower(map);
  if (kind == "cable") return cable(map);
  if (kind == "frame2d") return frame2d(map);
  if (kind == "shear_frame") return storeys(map);
  if (kind == "matrices") return matrices(map, std::filesystem::path(file).parent_path());
  if (kind == "modes") return modes(map);
  map.refuse("kind", fmt::format("`{}` is not known; write one of {}", printable(kind), structure_kinds()));
}

}  // namespace

core::structure::DeclaredFrame parse_structure_kind(const YamlNode& section, const std::string& file) {
  const StructureMap map(section, "structure", file);
  const std::string kind = map.text("kind");
  try {
    const std::size_t usual = kind == "matrices" ? 12 : 8;
    auto declared = core::structure::declare(model_of(kind, map, file), map.whole_or("modes", 1, 40, usual));
    const char* usual_stiffness = kind == "cable" ? "known" : "fitted";
    if (map.one_of("stiffness", {usual_stiffness, kind == "cable" ? "fitted" : "known"}) == "known")
      declared.stiffness_over_mass_per_s2 = 1.0;
    declared.temperature = parse_temperature(map);
    declared.frequency_sigma = 0.01 * map.number_or("frequency_sigma_percent", 1e-4, 20.0, 0.15);
    declared.shape_sigma = map.number_or("shape_sigma", 1e-4, 1.0, 0.02);
    core::structure::validate(declared);
    return declared;
  } catch (const std::invalid_argument& error) {
    throw FileError(fmt::format("{}:{}: structure: {}", file, section.line, error.what()));
  }
}

std::optional<core::structure::TemperatureLaw> parse_temperature(const StructureMap& map) {
  if (!map.has("temperature")) return std::nullopt;
  const StructureMap own = map.map("temperature");
  own.allow({"stiffness_per_k", "axial_n_per_k"});
  return core::structure::TemperatureLaw{own.number_or("stiffness_per_k", -0.05, 0.05, 0.0),
                                         own.number_or("axial_n_per_k", -1e12, 1e12, 0.0)};
}

const char* structure_kinds() { return "shear_frame, beam, tower, cable, frame2d, matrices, modes"; }

std::string structure_kinds_help() {
  return "Other kinds (examples: tools/guide/structures.md): beam, tower, cable, frame2d, matrices, modes, and "
         "shear_frame\n"
         "with locate: true. Keys common to them:\n"
         "  stiffness                   fitted | known: whether a common factor of stiffness over mass is fitted\n"
         "  modes                       number of modes of the model that may be referred to\n"
         "  temperature                 {stiffness_per_k, axial_n_per_k}: relative change of the stiffness of all "
         "parts, "
         "and\n"
         "                              change of axial forces, per kelvin: tests another temperature\n"
         "  couplings                   frame2d: [{from, to, stiffness_n_per_m: 0}]: nodes between which a spring may "
         "act\n"
         "  regions                     [{name, at_m: [x, y, z], direction: [x, y, z]}]: where channels look\n";
}

}  // namespace drivers
