// SPDX-License-Identifier: Apache-2.0
#include "src/io/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>

#include "src/io/collective.hpp"
#include "src/io/shared_hdf5.hpp"
#include "src/io/stretches.hpp"
#include "src/io/xdmf_series.hpp"

namespace spindrift::io {

namespace fs = std::filesystem;
using hdf5::SharedFile;

/// What grids and particles share: the folder, the series, and the naming of files.
struct Series {
  MPI_Comm comm;
  fs::path folder;
  std::string name;
  std::vector<Field> fields;
  std::optional<XdmfSeries> xdmf{};  // rank 0

  void open(double resume_s) {
    on_root(comm, [&] {
      fs::create_directories(folder);
      xdmf.emplace(folder / (name + ".xdmf"), name, resume_s);
    });
  }
  std::string file(std::int64_t tick) const { return fmt::format("{}_{:018}.h5", name, tick); }
  void append(double time_s, const std::string& grid) {
    on_root(comm, [&] { xdmf->append(time_s, grid); });
  }
  bool ends_with(double time_s) const {
    int same = rank_of(comm) == 0 && xdmf->last_s() == time_s ? 1 : 0;
    MPI_Bcast(&same, 1, MPI_INT, 0, comm);
    return same == 1;
  }
};

namespace {

std::string item(const std::string& dimensions, const char* type, int bytes, const std::string& file, const std::string& path) {
  return fmt::format("<DataItem Dimensions=\"{}\" NumberType=\"{}\" Precision=\"{}\" Format=\"HDF\">{}:/{}</DataItem>",
                     dimensions, type, bytes, file, path);
}

std::string attribute(const Field& field, const std::string& dimensions, const char* centre, const std::string& file,
                      const std::string& path) {
  const char* type = field.components == 1   ? "Scalar"
                     : field.components == 3 ? "Vector"
                     : field.components == 6 ? "Tensor6"
                                             : "Tensor";
  const std::string shape = field.components == 1 ? dimensions : fmt::format("{} {}", dimensions, field.components);
  return fmt::format("<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">{}</Attribute>\n", field.name, type, centre,
                     item(shape, "Float", int(field.precision), file, path));
}

std::vector<hsize_t> with_components(std::vector<hsize_t> extents, int components) {
  if (components > 1) extents.push_back(static_cast<hsize_t>(components));
  return extents;
}

SharedFile::Array field_array(const std::string& path, const std::vector<hsize_t>& extents, const Field& field) {
  const hid_t type = field.precision == Precision::full ? H5T_NATIVE_DOUBLE : H5T_NATIVE_FLOAT;
  return {path, type, with_components(extents, field.components),
          [unit = field.unit](hid_t dataset) { hdf5::set_attribute(dataset, "unit", unit); }};
}

void write_values(SharedFile& file, std::int64_t place, std::span<const double> values, Precision precision,
                  std::vector<float>& buffer) {
  if (precision == Precision::full) {
    file.write(place, std::as_bytes(values));
    return;
  }
  buffer.assign(values.begin(), values.end());
  file.write(place, std::as_bytes(std::span(buffer)));
}

void require_size(std::size_t found, std::size_t expected, const std::string& what) {
  if (found != expected) throw std::logic_error(fmt::format("field output of {}: {} values, expected {}", what, found, expected));
}

void set_time(SharedFile& file, double time_s) {
  file.on_root([&](hid_t id) { hdf5::set_attribute(id, "time_s", H5T_NATIVE_DOUBLE, &time_s); });
}

}  // namespace

struct GridFields::Impl {
  Series series;
  std::vector<GridBlock> blocks;
  bool moves;
  std::string points_file{};  // that has the points of the next output

  /// Elements of an array along i, j, k: of cells, or of corners, one more than these.
  static Stretches::Index extents(const std::array<int, 3>& low, const std::array<int, 3>& high, bool surface, bool corners) {
    Stretches::Index n;
    for (std::size_t d = 0; d < 3; ++d) n[d] = high[d] - low[d] + (corners ? 1 : 0);
    if (surface) n[2] = 1;
    return n;
  }
  static Stretches::Index extents(const GridBlock& b, bool corners) {
    return extents({0, 0, 0}, {b.ni, b.nj, b.nk}, b.nk == 0, corners);
  }

  /// Points first where they are written, then field by field, each of all blocks.
  std::vector<SharedFile::Array> arrays(bool with_points) const {
    std::vector<SharedFile::Array> list;
    const auto shape = [](const GridBlock& b, bool corners) {
      const Stretches::Index n = extents(b, corners);
      std::vector<hsize_t> found(n.rbegin() + (b.nk == 0 ? 1 : 0), n.rend());
      return found;
    };
    for (const GridBlock& b : blocks)
      if (with_points) list.push_back({b.name + "/points", H5T_NATIVE_DOUBLE, with_components(shape(b, true), 3), {}});
    for (const Field& field : series.fields)
      for (const GridBlock& b : blocks) list.push_back(field_array(b.name + "/" + field.name, shape(b, false), field));
    return list;
  }

  void require_sizes(const Values& values, bool with_points) const {
    const GridBlock& b = blocks.at(static_cast<std::size_t>(values.block));
    const auto elements = [&](bool corners) {
      const Stretches::Index n = extents(values.low, values.high, b.nk == 0, corners);
      return static_cast<std::size_t>(n[0] * n[1] * n[2]);
    };
    if (with_points) require_size(values.points.size(), 3 * elements(true), b.name + "/points");
    require_size(values.fields.size(), series.fields.size(), b.name + " (number of fields)");
    for (std::size_t f = 0; f < series.fields.size(); ++f)
      require_size(values.fields[f].size(), elements(false) * static_cast<std::size_t>(series.fields[f].components),
                   b.name + "/" + series.fields[f].name);
  }

  /// What is here of all blocks' cells or corners, and where a field's values of it are.
  struct Boxes {
    std::vector<Stretches::Index> blocks{};
    std::vector<Stretches::Box> mine{};
    std::vector<Stretches::Source> sources{};
  };
  Boxes boxes(std::span<const Values> mine, bool corners) const {
    Boxes found;
    for (const GridBlock& b : blocks) found.blocks.push_back(extents(b, corners));
    for (const Values& values : mine) {
      const GridBlock& b = blocks.at(static_cast<std::size_t>(values.block));
      Stretches::Box& box = found.mine.emplace_back(Stretches::Box{values.block, {}, {}});
      const Stretches::Index n = extents(values.low, values.high, b.nk == 0, corners);
      const std::array<int, 3> ends{b.ni, b.nj, b.nk};
      for (std::size_t d = 0; d < 3; ++d) {
        box.low[d] = values.low[d], box.high[d] = box.low[d] + n[d];
        if (corners && values.high[d] < ends[d]) box.high[d] -= 1;
      }
      found.sources.push_back({{}, n[0], n[0] * n[1]});
    }
    return found;
  }

  std::string grid(double time_s, const std::string& file) const {
    std::string text = fmt::format(
        "<Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"Spatial\">\n<Time Value=\"{}\"/>\n", series.name, time_s);
    for (const GridBlock& b : blocks) {
      const bool surface = b.nk == 0;
      const std::string corners = surface ? fmt::format("{} {}", b.nj + 1, b.ni + 1)
                                          : fmt::format("{} {} {}", b.nk + 1, b.nj + 1, b.ni + 1),
                        cells = surface ? fmt::format("{} {}", b.nj, b.ni) : fmt::format("{} {} {}", b.nk, b.nj, b.ni);
      text += fmt::format("<Grid Name=\"{}\" GridType=\"Uniform\"><Topology TopologyType=\"{}DSMesh\" Dimensions=\"{}\"/>\n",
                          b.name, surface ? 2 : 3, corners);
      text +=
          "<Geometry GeometryType=\"XYZ\">" + item(corners + " 3", "Float", 8, points_file, b.name + "/points") + "</Geometry>\n";
      for (const Field& field : series.fields) text += attribute(field, cells, "Cell", file, b.name + "/" + field.name);
      text += "</Grid>\n";
    }
    return text + "</Grid>\n";
  }
};

GridFields::GridFields(MPI_Comm comm, fs::path folder, std::string name, std::vector<GridBlock> blocks, std::vector<Field> fields,
                       bool moves, double resume_s)
    : impl_(new Impl{{comm, std::move(folder), std::move(name), std::move(fields)}, std::move(blocks), moves}) {
  impl_->series.open(resume_s);
}
GridFields::~GridFields() = default;

void GridFields::write(std::int64_t tick, double time_s, std::span<const Values> mine) {
  Series& series = impl_->series;
  const std::string name = series.file(tick);
  const bool with_points = impl_->moves || impl_->points_file.empty();
  if (with_points) impl_->points_file = name;
  SharedFile file(series.comm, series.folder / name);
  set_time(file, time_s);
  file.on_root([&](hid_t id) { hdf5::set_attribute(id, "points_file", impl_->points_file); });
  const std::vector<std::int64_t> all = file.add(impl_->arrays(with_points));
  std::span<const std::int64_t> places(all);

  Impl::Boxes corners, cells;
  together(series.comm, [&] {
    for (const Values& values : mine) impl_->require_sizes(values, with_points);
    if (with_points) corners = impl_->boxes(mine, true);
    cells = impl_->boxes(mine, false);
  });
  const std::size_t count = impl_->blocks.size();
  if (with_points) {
    for (std::size_t n = 0; n < mine.size(); ++n) corners.sources[n].values = mine[n].points;
    Stretches(series.comm, corners.blocks, corners.mine).write<double>(file, places.first(count), 3, corners.sources);
    places = places.subspan(count);
  }
  Stretches stretches(series.comm, cells.blocks, cells.mine);
  for (std::size_t f = 0; f < series.fields.size(); ++f) {
    for (std::size_t n = 0; n < mine.size(); ++n) cells.sources[n].values = mine[n].fields[f];
    const Field& field = series.fields[f];
    if (field.precision == Precision::full)
      stretches.write<double>(file, places.subspan(f * count, count), field.components, cells.sources);
    else
      stretches.write<float>(file, places.subspan(f * count, count), field.components, cells.sources);
  }
  file.commit();
  series.append(time_s, impl_->grid(time_s, name));
}

bool GridFields::ends_with(double time_s) const { return impl_->series.ends_with(time_s); }

struct ParticleFields::Impl {
  Series series;

  std::string grid(double time_s, const std::string& file, std::int64_t count) const {
    const std::string n = std::to_string(count);
    std::string text = fmt::format("<Grid Name=\"{}\" GridType=\"Uniform\">\n<Time Value=\"{}\"/>\n", series.name, time_s);
    // Each particle a cell by its number: without the list ParaView's default reader (Xdmf3) has points and shows none.
    text += fmt::format("<Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" NodesPerElement=\"1\">{}</Topology>\n", n,
                        item(n, "Int", 8, file, "vertex"));
    text += "<Geometry GeometryType=\"XYZ\">" + item(n + " 3", "Float", 8, file, "position") + "</Geometry>\n";
    text += "<Attribute Name=\"id\" AttributeType=\"Scalar\" Center=\"Node\">" + item(n, "Int", 8, file, "id") + "</Attribute>\n";
    for (const Field& field : series.fields) text += attribute(field, n, "Node", file, field.name);
    return text + "</Grid>\n";
  }
};

ParticleFields::ParticleFields(MPI_Comm comm, fs::path folder, std::string name, std::vector<Field> fields, double resume_s)
    : impl_(new Impl{{comm, std::move(folder), std::move(name), std::move(fields)}}) {
  impl_->series.open(resume_s);
}
ParticleFields::~ParticleFields() = default;

bool ParticleFields::ends_with(double time_s) const { return impl_->series.ends_with(time_s); }

void ParticleFields::write(std::int64_t tick, double time_s, std::span<const std::int64_t> ids, std::span<const double> positions,
                           std::span<const std::span<const double>> fields) {
  Series& series = impl_->series;
  const auto mine = static_cast<std::int64_t>(ids.size());
  std::int64_t before = 0, total = 0;
  MPI_Exscan(&mine, &before, 1, MPI_INT64_T, MPI_SUM, series.comm);
  if (rank_of(series.comm) == 0) before = 0;  // MPI leaves it undefined there
  MPI_Allreduce(&mine, &total, 1, MPI_INT64_T, MPI_SUM, series.comm);

  const std::string name = series.file(tick);
  SharedFile file(series.comm, series.folder / name);
  set_time(file, time_s);
  const auto extent = static_cast<hsize_t>(total);
  std::vector<SharedFile::Array> arrays = {{"position", H5T_NATIVE_DOUBLE, {extent, 3}, {}},
                                           {"id", H5T_NATIVE_INT64, {extent}, {}},
                                           {"vertex", H5T_NATIVE_INT64, {extent}, {}}};
  for (const Field& field : series.fields) arrays.push_back(field_array(field.name, {extent}, field));
  const std::vector<std::int64_t> places = file.add(arrays);
  together(series.comm, [&] {
    require_size(positions.size(), 3 * ids.size(), series.name + " positions");
    require_size(fields.size(), series.fields.size(), series.name + " (number of fields)");
    file.write(places[0] + before * 3 * 8, std::as_bytes(positions));
    file.write(places[1] + before * 8, std::as_bytes(ids));
    std::vector<std::int64_t> vertex(ids.size());
    std::iota(vertex.begin(), vertex.end(), before);
    file.write(places[2] + before * 8, std::as_bytes(std::span<const std::int64_t>(vertex)));
    std::vector<float> buffer;
    for (std::size_t f = 0; f < fields.size(); ++f) {
      const Field& field = series.fields[f];
      require_size(fields[f].size(), ids.size() * static_cast<std::size_t>(field.components), series.name + "/" + field.name);
      write_values(file, places[3 + f] + before * field.components * int(field.precision), fields[f], field.precision, buffer);
    }
  });
  file.commit();
  // A grid without a single point stops ParaView's reader; the file is there all the same.
  if (total > 0) series.append(time_s, impl_->grid(time_s, name, total));
}

}  // namespace spindrift::io
