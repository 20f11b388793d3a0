// SPDX-License-Identifier: Apache-2.0
#include "src/import/windio_tower.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernels/base/constants.hpp"

namespace spindrift::decks {

namespace {

/// From foot to top. Where a grid has an entry twice there is a step, over a millionth of the length.
Curve along_tower(const Key& key) {
  constexpr double step = 1e-6;
  Curve c{numbers(key.at("grid")), numbers(key.at("values"))};
  for (std::size_t i = 1; i + 1 < c.x.size(); ++i)
    if (c.x[i] == c.x[i - 1]) c.x[i] += step;
  require_increasing(key.at("grid"), c.x), require_whole_span(key.at("grid"), c.x);
  if (c.x.size() != c.y.size()) key.at("values").fail(fmt::format("has {} entries, grid has {}", c.y.size(), c.x.size()));
  return c;
}

Curve positive_along_tower(const Key& key) {
  Curve c = along_tower(key);
  for (const Key& value : key.at("values").entries()) value.positive();
  return c;
}

/// Height of the axis [m].
Curve height(const Key& shape) {
  const Key z = shape.at("reference_axis").at("z");
  Curve c = along_tower(z);
  for (std::size_t i = 1; i < c.y.size(); ++i)
    if (c.y[i] <= c.y[i - 1]) z.at("values").entries()[i].fail("must be more than the entry before it");
  return c;
}

std::vector<double> all_stations(const std::vector<const Curve*>& curves) {
  std::vector<double> stations;
  for (const Curve* c : curves) stations.insert(stations.end(), c->x.begin(), c->x.end());
  std::ranges::sort(stations);
  stations.erase(std::unique(stations.begin(), stations.end()), stations.end());
  return stations;
}

struct Material {
  double density, youngs, shear;  ///< [kg/m3], [Pa], [Pa]
};

Material material_named(const Key& top, const Key& name) {
  for (const Key& material : top.at("materials").entries()) {
    if (material.at("name").text() != name.text()) continue;
    const double youngs = material.at("E").positive();
    return {material.at("rho").positive(), youngs,
            material.has("G") ? material.at("G").positive() : 0.5 * youngs / (1.0 + material.at("nu").positive())};
  }
  name.fail("is the name of no entry of materials");
}

struct Layer {
  Material material;
  Curve thickness;  ///< [m]
};

}  // namespace

std::string tower_in_the_air(const Key& tower, std::vector<std::string>& left_out) {
  const Key shape = tower.at("outer_shape_bem"), axis = shape.at("reference_axis");
  const Curve z = height(shape), diameter = positive_along_tower(shape.at("outer_diameter")), x = along_tower(axis.at("x")),
              y = along_tower(axis.at("y"));
  const bool has_drag = shape.has("drag_coefficient");
  const Curve drag = has_drag ? along_tower(shape.at("drag_coefficient")) : Curve{{0.0, 1.0}, {0.0, 0.0}};
  for (std::size_t i = 0; i < drag.y.size(); ++i)
    if (drag.y[i] < 0.0) shape.at("drag_coefficient").at("values").entries()[i].fail("must not be negative");
  for (const Curve* c : {&x, &y})
    if (std::ranges::any_of(c->y, [&](double value) { return value != c->y.front(); })) {
      left_out.push_back("the lean of the tower's axis: it stands upright over its foot");
      break;
    }
  std::string text = "\n[aero.tower]\n";
  if (x.y.front() != 0.0 || y.y.front() != 0.0) text += fmt::format("foot_m = [{:.9g}, {:.9g}]\n", x.y.front(), y.y.front());
  if (!has_drag) text += "has_drag = false\n";
  text += "stations = [\n";
  for (const double s : all_stations({&z, &diameter, &drag}))
    text += fmt::format("  [{:.9g}, {:.9g}, {:.9g}],\n", z.at(s), diameter.at(s), drag.at(s));
  return text + "]\n";
}

std::string tower_table(const Key& top) {
  const Key tower = top.at("components").at("tower"), shape = tower.at("outer_shape_bem"),
            structure = tower.at("internal_structure_2d_fem");
  const Curve z = height(shape), diameter = positive_along_tower(shape.at("outer_diameter"));
  const double outfitting = structure.has("outfitting_factor") ? structure.at("outfitting_factor").positive() : 1.0;
  std::vector<Layer> layers;
  std::vector<const Curve*> curves{&z, &diameter};
  for (const Key& layer : structure.at("layers").entries())
    layers.push_back({material_named(top, layer.at("material")), positive_along_tower(layer.at("thickness"))});
  for (const Layer& layer : layers) curves.push_back(&layer.thickness);
  std::string table = "distance_m,mass_kg_m,stiffness_x_N_m2,stiffness_y_N_m2,axial_N,torsion_N_m2\n";
  for (const double s : all_stations(curves)) {
    double outer = 0.5 * diameter.at(s), mass = 0.0, bending = 0.0, axial = 0.0, torsion = 0.0;
    for (const Layer& layer : layers) {
      const double inner = outer - layer.thickness.at(s);
      if (inner < 0.0)
        structure.at("layers").fail(
            fmt::format("are thicker together than half of the outer diameter {:g} m at {:g} of the height", diameter.at(s), s));
      const double area = pi * (outer * outer - inner * inner), second = 0.25 * pi * (std::pow(outer, 4) - std::pow(inner, 4));
      mass += outfitting * layer.material.density * area;
      bending += layer.material.youngs * second, axial += layer.material.youngs * area;
      torsion += 2.0 * layer.material.shear * second;
      outer = inner;
    }
    table +=
        fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", z.at(s) - z.y.front(), mass, bending, bending, axial, torsion);
  }
  return table;
}

}  // namespace spindrift::decks
