// SPDX-License-Identifier: Apache-2.0
#include "tests/readers/readers.hpp"

#include <mpi.h>

#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "runtime/replay/recording_file.hpp"
#include "src/aero/control_options.hpp"
#include "src/aero/grid/cgns.hpp"
#include "src/aero/grid/connect.hpp"
#include "src/aero/grid/neutral_map.hpp"
#include "src/aero/grid/plot3d.hpp"
#include "src/aero/operation.hpp"
#include "src/aero/prescribed.hpp"
#include "src/aero/turbine.hpp"
#include "src/aero/turbulence_box.hpp"
#include "src/aero/wind.hpp"
#include "src/bodies/beam_options.hpp"
#include "src/import/elastodyn.hpp"
#include "src/import/line_files.hpp"
#include "src/import/windio.hpp"
#include "src/io/checkpoint.hpp"
#include "src/io/machine_failure.hpp"
#include "src/moorings/bed_file.hpp"
#include "src/moorings/table_file.hpp"
#include "src/scene/columns.hpp"
#include "src/scene/surface_file.hpp"
#include "src/sea/wamit.hpp"
#include "src/sea/wave_field.hpp"
#include "tests/src/import/windio_sample.hpp"

namespace spindrift::testing {

namespace {

using Path = const std::string&;
using Write = std::function<void(Path)>;

Write text(std::string words) {
  return [words = std::move(words)](Path file) { std::ofstream(file) << words; };
}
/// A file of inputs/ in its place.
Write input(std::string name) {
  return [name = std::move(name)](Path file) {
    std::filesystem::copy_file(std::string(SPINDRIFT_SOURCE_DIR) + "/inputs/" + name, file,
                               std::filesystem::copy_options::overwrite_existing);
  };
}

/// Two blocks side by side, four and two cells.
aero::MultiBlockGrid small_grid() {
  aero::MultiBlockGrid grid;
  for (int b = 0; b < 2; ++b) {
    aero::Block& block = grid.blocks.emplace_back(aero::Block{.name = b == 0 ? "left" : "right", .ni = 2 - b, .nj = 2, .nk = 1});
    for (int k = 0; k <= block.nk; ++k)
      for (int j = 0; j <= block.nj; ++j)
        for (int i = 0; i <= block.ni; ++i) block.nodes.emplace_back(2.0 * b + i, j, k);
  }
  return grid;
}

void write_box(Path file) {
  aero::BtsFile box{.up = 2,
                    .across = 2,
                    .tower = 1,
                    .steps = 3,
                    .up_m = 5,
                    .across_m = 5,
                    .step_s = 0.1f,
                    .wind = 8,
                    .hub_height = 90,
                    .bottom = 80,
                    .description = "small"};
  box.grid.assign(3 * 2 * 2 * 3, 5), box.towers.assign(3 * 1 * 3, 4);
  aero::write_bts(box, file);
}

void write_checkpoint(Path file) {
  const std::vector<double> values{1.0, 2.0, 3.0};
  io::CheckpointWriter writer(MPI_COMM_SELF, file);
  writer.write("sea/position", std::span<const double>(values));
  writer.set("time_s", 2.5), writer.set("tick", std::int64_t(7)), writer.set("scene", std::string("a.toml"));
  writer.commit();
}
void read_checkpoint(Path file) {
  const io::CheckpointReader reader(MPI_COMM_SELF, file);
  if (reader.has("sea/position")) (void)reader.read<double>("sea/position");
  if (reader.has("time_s")) (void)reader.number("time_s");
}

void read_recording(Path file) {
  try {
    (void)runtime::read_recording(file);
  } catch (const std::runtime_error& error) { throw io::InputError(error.what()); }
}
void write_recording(Path file) {
  runtime::RankRecording rank;
  rank.graphs.resize(1);
  rank.graphs[0].data.resize(1);
  rank.graphs[0].nodes.push_back({.label = "sea/a", .uses = {{0, runtime::Access::update}}});
  runtime::RunRecord run{.window = 1, .wall_ns = 10, .task_ns = 10};
  run.ns = {{10}}, run.iterations = {{}};
  rank.runs.push_back(run);
  runtime::write_recording({.scene = "a.toml", .program = "0", .windows = {{1, 10}}, .ranks = {rank}}, file, MPI_COMM_SELF);
}

void read_map(Path file) {
  aero::MultiBlockGrid grid = small_grid();
  aero::read_neutral_map(grid, file);
}
void write_map(Path file) {
  aero::MultiBlockGrid grid = small_grid();
  aero::connect_by_coordinates(grid);
  aero::write_neutral_map(grid, file);
}

/// A corner of a cube, closed.
constexpr std::array<std::array<std::array<float, 3>, 3>, 4> tetrahedron{{{{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}},
                                                                          {{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}}},
                                                                          {{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}},
                                                                          {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}}};
void read_surface(Path file) {
  scene::MeshOptions mesh;
  mesh.file = file;
  scene::load_surface(mesh);
}
void write_stl(Path file) {
  std::ofstream out(file);
  out << "solid corner\n";
  for (const auto& facet : tetrahedron) {
    out << "facet\nouter loop\n";
    for (const auto& corner : facet) out << "vertex " << corner[0] << ' ' << corner[1] << ' ' << corner[2] << '\n';
    out << "endloop\nendfacet\n";
  }
  out << "endsolid\n";
}
void write_binary_stl(Path file) {
  std::ofstream out(file, std::ios::binary);
  out << std::string(80, ' ');
  const auto put = [&](const auto& value) { out.write(reinterpret_cast<const char*>(&value), sizeof value); };
  put(std::uint32_t(tetrahedron.size()));
  for (const auto& facet : tetrahedron) put(std::array<float, 3>{}), put(facet), put(std::uint16_t(0));
}

void read_turbine_of_windio(Path file) {
  const auto folder = std::filesystem::temp_directory_path() / ("spindrift_windio_seed_" + std::to_string(getpid()));
  decks::import_windio(file, folder);
}

template <decks::ImportedMoorings read(const decks::Deck&, double, std::vector<std::string>&)>
void read_lines(Path file) {
  std::vector<std::string> left_out;
  (void)read(decks::Deck(file), 200.0, left_out);
}

}  // namespace

const std::vector<Reader>& readers() {
  static const sea::WamitScale scale{10.0, 1025.0, 9.81};
  static const std::vector<Reader> all{
      {"columns", true, [](Path f) { (void)scene::read_columns(f); }, text("time_s,a,b\n0,1,2\n1,3,4\n2,5,6\n")},
      {"blank_columns", true,
       [](Path f) {
         (void)scene::read_blank_columns(f, {"a", "b"});
       },
       text("a title\n0 1\n1 3\n2 5\n"), true},
      {"line_table", true, [](Path f) { (void)moorings::read_line_table(f); },
       text("distance_m,tension_N\n100,0\n110,1e5\n120,3e5\n")},
      {"controller", true, [](Path f) { (void)aero::read_controller(f); }, input("turbines/dtu_10mw_controller.toml")},
      {"operation", true, [](Path f) { (void)aero::read_operation(f); }, input("turbines/dtu_10mw_operation.csv")},
      {"turbine", true, [](Path f) { (void)aero::read_turbine(f); },
       [](Path f) {
         input("turbines/dtu_10mw.toml")(f);
         const auto beside = std::filesystem::path(f).parent_path();
         std::filesystem::copy(std::string(SPINDRIFT_SOURCE_DIR) + "/inputs/turbines", beside,
                               std::filesystem::copy_options::recursive | std::filesystem::copy_options::skip_existing);
       }},
      {"outline", true, [](Path f) { (void)aero::read_outline(f); }, input("tutorials/naca4412.dat"), true, ".dat"},
      {"bts", false, [](Path f) { (void)aero::box_of(aero::read_bts(f)); }, write_box},
      {"mann", false,
       [](Path f) {
         (void)aero::read_mann({f, f, f}, {{2, 2, 2}, {5.0, 5.0, 5.0}}, 8.0, 90.0);
       },
       text(std::string(32, '\1'))},
      {"radiation", true, [](Path f) { (void)sea::read_radiation(f, scale); },
       text("-1 1 1 2.0\n0 1 1 1.5\n4.0 1 1 1.8 0.1\n4.0 3 5 0.2 0.01\n8.0 1 1 1.7 0.2\n8.0 3 5 0.3 0.02\n")},
      {"excitation", true, [](Path f) { (void)sea::read_excitation(f, scale); },
       text("4.0 0.0 1 1.0 10.0 0.98 0.17\n4.0 0.0 3 2.0 0.0 2.0 0.0\n8.0 0.0 1 1.2 90.0 0.0 1.2\n8.0 0.0 3 2.1 0.0 2.1 0.0\n")},
      {"hydrostatics", true, [](Path f) { (void)sea::read_hydrostatics(f, scale); }, text("3 3 12.5\n4 4 -3.0\n5 5 -3.0\n")},
      {"drift", true, [](Path f) { (void)sea::read_drift(f, scale); },
       text("4.0 0.0 0.0 1 0.5 0.0 0.5 0.0\n8.0 0.0 0.0 1 0.1 0.0 0.1 0.0\n")},
      {"quadratic", true, [](Path f) { (void)sea::read_quadratic(f, scale, sea::FrequencyPair::difference); },
       text("4.0 4.0 0.0 0.0 1 0.5 0.0 0.5 0.0\n4.0 8.0 0.0 0.0 1 0.2 0.0 0.2 0.0\n8.0 8.0 0.0 0.0 1 0.1 0.0 0.1 0.0\n")},
      {"plot3d", true, [](Path f) { (void)aero::read_plot3d(f); }, [](Path f) { aero::write_plot3d(small_grid(), f); }},
      {"plot3d_binary", false, [](Path f) { (void)aero::read_plot3d(f); },
       [](Path f) { aero::write_plot3d(small_grid(), f, aero::Plot3dForm::binary); }},
      {"map", true, read_map, write_map},
      {"cgns", false, [](Path f) { (void)aero::read_cgns(f); }, [](Path f) { aero::write_cgns(small_grid(), f); }},
      {"moordyn", true, read_lines<decks::read_moordyn>,
       text(
           "=== LINE TYPES ===\nName Diam MassDen EA BA/-zeta EI Cd Ca CdAx CaAx\n() (m) (kg/m) (N) () () () () () ()\n"
           "chain 0.1 100 4e8 -1 0 1 1 0 0\n=== POINTS ===\nID Attachment X Y Z M V CdA CA\n() () (m) (m) (m) (kg) (m3) (m2) ()\n"
           "bed Fixed 500 0 -200 0 0 0 0\nhull Vessel 4 0 -30 0 0 0 0\ncrow Free 50 0 -60 1000 0.5 2.5 0.7\n=== LINES ===\n"
           "ID LineType AttachA AttachB UnstrLen NumSegs Outputs\n() (name) () () (m) () ()\nlong chain bed crow 490 20 p\n"
           "short chain crow hull 56 5 p\n=== OPTIONS ===\n3e6 kBot\n3e5 cBot\n0.3 FrictionCoefficient\n")},
      {"map_plus_plus", true, read_lines<decks::read_map>,
       text(
           "=== LINE DICTIONARY ===\nLineType Diam MassDenInAir EA CB CIntDamp Ca Cdn Cdt\n() (m) (kg/m) (N) () (Pas) () () ()\n"
           "chain 0.1 100 4e8 0.5 1 1 1 1\n=== NODE PROPERTIES ===\nNode Type X Y Z M B FX FY FZ\n"
           "() () (m) (m) (m) (kg) (mB) (N) (N) (N)\nbed fix 500 0 depth 0 0 0 0 0\nhull Vessel 4 0 -30 0 0 0 0 0\n"
           "crow Connect 50 0 -60 1000 0.5 0 0 0\n=== LINE PROPERTIES ===\nLine LineType UnstrLen NodeAnch NodeFair Flags\n"
           "() () (m) () () ()\nlong chain 490 bed crow plot\nshort chain 56 crow hull plot\n=== SOLVER OPTIONS ===\nOption\n()\n"
           "repeat 120 240\n")},
      {"stl", true, read_surface, write_stl, true, ".stl"},
      {"stl_binary", false, read_surface, write_binary_stl, false, ".stl"},
      {"bed", true, [](Path f) { (void)moorings::read_bed(f); },
       text("x_m,y_m,depth_m\n0,0,100\n500,0,120\n0,300,110\n500,300,150\n")},
      {"beam", true,
       [](Path f) {
         bodies::BeamOptions beam;
         beam.end_m = {0.0, 0.0, 10.0}, beam.properties = f;
         (void)bodies::read_properties(beam);
       },
       text("distance_m,diameter_m,thickness_m\n0,6,0.05\n4,5.5,0.04\n10,5,0.03\n")},
      {"wind_table", true,
       [](Path f) {
         aero::WindOptions wind;
         wind.table = f;
         (void)aero::turns(wind);
       },
       text("time_s,speed_m_s,direction_deg\n0,8,0\n10,9,5\n20,11,-5\n")},
      {"load_table", true,
       [](Path f) {
         aero::AeroOptions rotor;
         rotor.table = f, rotor.interpolation = "cubic";
         (void)aero::Prescribed(rotor);
       },
       text("time_s,thrust_N,torque_N_m\n0,1e5,1e6\n10,2e5,2e6\n")},
      {"elevation", true,
       [](Path f) {
         sea::WavesOptions waves;
         waves.model = "elevation", waves.file = f;
         (void)sea::WaveField(waves, {});
       },
       [](Path f) {
         std::ofstream out(f);
         out << "time_s,elevation_m\n";
         for (int n = 0; n < 24; ++n) out << n << ',' << (n % 8 < 4 ? 1 : -1) * (1 + n % 3) << '\n';
       }},
      {"elastodyn", true, [](Path f) { (void)decks::rotor_frame(decks::Deck(f)); },
       text("ElastoDyn\n3 NumBl\n40 TipRad\n2 HubRad\n-3 PreCone1\n-4 OverHang\n-6 ShftTilt\n2 Twr2Shft\n60 TowerHt\n"
            "10 TowerBsHt\n10 RotSpeed\n5 PtfmPitch\n3000000 PtfmMass\n50 GBRatio\n95 GBoxEff\n"),
       true},
      {"windio", true, read_turbine_of_windio, text(small_turbine), false, ".yaml"},
      {"recording", true, read_recording, write_recording},
      {"checkpoint", false, read_checkpoint, write_checkpoint},
  };
  return all;
}

}  // namespace spindrift::testing
