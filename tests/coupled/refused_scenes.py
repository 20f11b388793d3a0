"""Scenes that cannot be run: each must be refused by `check` within two seconds and by `run` in the same words, with the key that must be named, and
nothing that `check` calls valid may be refused by `run`. Usage: refused_scenes.py SPINDRIFT

A line of TABLE is a scene of inputs/, then overrides of it, one case each: KEY=VALUE, and after " : " the key that must be named where it is not KEY;
several overrides of one case are joined by " & "."""
import concurrent.futures
import os
import re
import resource
import subprocess
import sys
import tempfile
import time

from running import ROOT, sanitized, spindrift

EVERY = """
time.end_s=-1.0
time.end_s=0.0
time.end_s="long"
time.end_s=1e300
time.window_s=0.0
time.window_s=-0.1
time.window_s=nan
time.window_s=1e9
time.integrator="euler"
time.colour="red"
environment.gravity_m_s2=-9.81
environment.gravity_m_s2=inf
output.history_every=0
output.history_every=1.5
output.means_over_s=-1.0
checkpoint.keep=0
checkpoint.wall_interval_s=-1.0
checkpoint.interval_s="often"
runtime.wall_limit_s=-5.0
start.ramp_s=-1.0
start.equilibrium="yes"
start.file="nowhere.h5"
unknown.key=1
"""
WATER = """
environment.water_density_kg_m3=0.0
environment.water_depth_m=-20.0
environment.water_depth_m=1e9
"""
BODIES = """
bodies.platform.mass_kg=0.0
bodies.platform.mass_kg=-1e6
bodies.platform.mass_kg="heavy"
bodies.platform.inertia_kg_m2=[1.0]
bodies.platform.inertia_kg_m2=[1.0, 1.0, 1e9]
bodies.platform.inertia_kg_m2=[-1e9, 1e9, 1e9]
bodies.platform.centre_m=[0.0, 0.0]
bodies.platform.colour="red"
bodies.platform.cylinders[0].diameter_m=0.0
bodies.platform.cylinders[0].diameter_m=-1.0
bodies.platform.cylinders[0].end_m=[46.7, 0.0, -14.0] : bodies.platform.cylinders[0]
bodies.platform.cylinders[0].start_m=[46.7, 0.0, -400.0] : bodies.platform.cylinders[0]
bodies.platform.cylinders[7].diameter_m=1.0
joints.bearing.type="ball joint"
joints.bearing.bodies=["platform"]
joints.bearing.bodies=["platform", "nobody"]
joints.bearing.bodies=["platform", "platform"]
joints.bearing.axis=[0.0, 0.0, 0.0]
joints.bearing.rotation.speed_rpm="fast"
moorings.line_downwind.body="nobody"
moorings.line_downwind.rest_length_m=0.0
moorings.line_downwind.rest_length_m=-1.0
moorings.line_downwind.model="rope"
moorings.line_downwind.axial_stiffness_N=0.0
moorings.line_downwind.stiffness_N_m=1e6
moorings.line_downwind.anchor_m=[46.7, 0.0, -7.0]
moorings.line_downwind.damping_N_s_m=-1.0
moorings.line_downwind.table="/dev/zero"
time.step_s=0.03
time.step_s=-0.05
time.step_s=0.0
"""
ROTOR = """
wind.speed_m_s=-11.0
wind.speed_m_s=nan
wind.direction_deg="north"
rotor.turbine="nothing.toml"
rotor.turbine="/dev/zero"
rotor.turbine="/etc/hostname"
rotor.diameter_m=178330.0
rotor.body="nobody"
rotor.joint="nothing"
rotor.operation="/dev/zero"
aero.model="lifting_line"
coupling.scheme="loose"
coupling.scheme="css" & coupling.predictor_order=7 : coupling.predictor_order
coupling.scheme="aitken" & coupling.relaxation=2.0 : coupling.relaxation
coupling.scheme="aitken" & coupling.tolerance=0.0 : coupling.tolerance
coupling.scheme="iqn_ils" & coupling.samples=3 : coupling.samples
coupling.scheme="cps2" & coupling.tolerance=1e-4 : coupling.tolerance
coupling.air_ranks=2
"""
TABLE = {
    "leble_barakos/case1_engineering.toml": EVERY + WATER + BODIES + """
time.step_s=5.0 & time.window_s=5.0 : time.step_s
time.integrator="explicit_euler" : time.integrator
aero.thrust_N="large"
sea.model="ocean"
""",
    "leble_barakos/flexible_blades.toml": """
time.step_s=0.1
rotor.blade_structure="nothing.csv"
rotor.blade_structure="/dev/zero"
rotor.blade_damping=[0.005]
rotor.blade_damping=[0.005, -0.01, 0.005]
rotor.blade_masses="../turbines/dtu_10mw/blade_masses.csv"
coupling.scheme="cps"
bodies.rotor.mass_kg=100000.0
""",
    "leble_barakos/case3_engineering.toml": EVERY + WATER + BODIES + ROTOR + """
coupling.scheme="cps2" & time.window_s=5.0 : time.window_s
coupling.scheme="cps" & time.window_s=20.0 : time.window_s
sea.strip_length_m=1e-12
sea.strip_length_m=0.0
sea.strip_length_m=1e-5
sea.drag_coefficient=-1.0
sea.coefficients=[{cylinder="float_downwind", drag_coefficient=1.0}, {cylinder="float_downwind", drag_coefficient=20.0}] : sea.coefficients[1].cylinder
sea.damping[0].body="nobody"
waves.height_m=-1.0
waves.height_m=30.0 & waves.model="stokes2" : waves
waves.period_s=0.0
waves.model="tsunami"
waves.components=3
waves.second_order=true
waves.model="jonswap" & waves.second_order=true & waves.spreading_exponent=2.0 : waves.spreading_exponent
waves.model="jonswap" & waves.second_order=true & waves.components=2000 : waves.components
waves.model="jonswap" & waves.second_order=true & waves.stretching="wheeler" : waves.stretching
start.equilibrium=false & moorings.line_downwind.tension_only=true & moorings.line_downwind.axial_stiffness_N=1e18 & moorings.line_downwind.rest_length_m=900.0 : moorings.line_downwind
""",
    "control/twin_rotor_floater.toml": """
rotor.body="platform" : rotor
rotors.port=3
rotors.port.body="nobody"
rotors.port.turbine="nothing.toml"
rotors.port.hub_m=[0.0, 0.0]
rotors.starboard.turns="backwards"
rotors.starboard.speed_rpm=9.0
rotors.starboard.joint="nothing"
rotors.third.body="platform" : rotors.third.turbine
rotors.starboard.tower_foot_m=[0.0, 105.0]
rotors.starboard.tower_foot_m=[0.0]
without=["rotors.starboard.tower_foot_m"] : rotors.starboard.tower_foot_m
without=["aero.tower"] : rotors.port.tower_foot_m
aero.tower.foot_m=[0.0, 0.0]
aero.model="none" : rotors
aero.model="blade_resolved" : rotors
aero.model="actuator_disc" : rotors
coupling.scheme="cps2"
control.model="library" : control.model
control.yaw.joint="bearing" & control.yaw.stiffness_N_m_rad=1e9 & control.yaw.damping_N_m_s_rad=1e9 : control.yaw
without=["wind.turbulence"] & wind.event.what="ews_vertical" & wind.event.start_s=1.0 : wind.event.what
wind.turbulence.width_m=200.0 : wind.turbulence
control.events=[{what="grid_loss", time_s=5.0, rotor="middle"}] : control.events[0].rotor
rotors.blade_1.body="platform" & rotors.blade_1.turbine="../turbines/dtu_10mw.toml" : rotors.blade_1
""",
    "leble_barakos/case1_demo.toml": EVERY + WATER + """
sea.particles.spacing_m=1e-6
sea.particles.spacing_m=1e-2
sea.particles.spacing_m=0.0
sea.particles.spacing_m=1e3
sea.particles.cfl=5.0
sea.particles.kernel="gauss"
sea.tank.top_m=1e8
sea.tank.top_m=-100.0
sea.tank.x_m=[10.0, -10.0]
sea.tank.x_m=[0.0]
sea.tank.y_m=[0.0, 0.0]
sea.tank.sides_x="ajar"
sea.fields.interval_s=-1.0
sea.fields.surface_spacing_m=1e-7
sea.fields.particles=["velocity", "velocity"]
sea.obstacles=[{low_m=[-1e3, -1e3, -1e3], high_m=[1e3, 1e3, 1e3]}] : sea.obstacles[0]
sea.gauges=[{name="platform.sea", point_m=[0.0, 0.0]}] : sea.gauges[0].name
sea.initial.state="calm"
""",
    "leble_barakos/case3_demo.toml": """
aero.grid.coarsen=3
aero.grid.coarsen=5
aero.grid.y_plus=-1.0
start.air_steps=-1
coupling.scheme="css" & time.window_s=60.0 & time.end_s=600.0 : time.window_s
sea.tank.y_m=[-44.0, 44.0] : bodies.platform
""",
    "leble_barakos/rotor_demo.toml": EVERY + """
wind.speed_m_s=-11.0
rotor.turbine="nothing.toml"
rotor.speed_rpm="fast"
rotor.axis=[0.0, 0.0, 0.0]
rotor.axis=[1e160, 0.0, 0.0]
rotor.body="platform"
aero.grid.resolution=0.0
aero.grid.resolution=1e6
aero.grid.sectors="two"
aero.grid.coarsen=5
aero.grid.cells_round=-4
aero.flow.time="implicit"
aero.flow.flux="central"
aero.flow.limiter="sharp"
aero.flow.cfl=-1.0
aero.flow.drop=2.0
aero.flow.krylov_steps=0
aero.flow.turbulence="magic"
aero.flow.preconditioner="magic"
sea.model="sph" : sea.particles
""",
    "validation/cylinder_low_mach/cylinder.toml": """
aero.flow.generate.around=0
aero.flow.generate.outward=1
aero.flow.generate.far_m=0.1
aero.flow.generate.kind="sphere"
aero.flow.generate.kind="box"
aero.flow.generate.refinement=2
aero.flow.boundaries[0].patch="nothing"
aero.flow.boundaries[0].condition="wet"
aero.flow.boundaries=[]
aero.flow.coarse_steps=-1
aero.flow.generate.around=97 & aero.flow.coarse_steps=10 : aero.flow.coarse_steps
wind.speed_m_s=0.0
aero.flow.temperature_K=-1.0
aero.flow.map="/etc/hostname"
""",
    "validation/actuator/disc.toml": """
rotor.hub_m=[0.0, 0.0, 50.0]
rotor.hub_m=[1e9, 0.0, 119.0]
rotor.turbine=""
rotor.turbine="nowhere.toml"
rotor.joint="bearing"
rotor.speed_rpm=8.0
rotor.diameter_m=300.0
rotor.blade_masses="/etc/hostname"
rotor.blade_structure="/etc/hostname"
sea.model="morison" : sea
start.equilibrium=true
moorings.line_1={model="spring_damper", body="spar", anchor_m=[9.0, 0.0, -9.0], fairlead_m=[0.0, 0.0, -5.0], rest_length_m=9.0, axial_stiffness_N=1e8, damping_N_s_m=0.0} : moorings
joints.bearing={type="revolute", bodies=["earth", "nobody"], point_m=[0.0, 0.0, 119.0], axis=[1.0, 0.0, 0.0]} : joints
aero.grid.resolution=1.0 : aero.grid
aero.actuator.width_cells=0.0
aero.actuator.width_cells=-2.0
aero.actuator.width_chords="wide"
aero.actuator.correction="some"
aero.model="actuator_line" : aero.flow.time
aero.model="bem" : rotor.body
aero.model="actuator_disk" : aero.model
aero.flow.generate.cell_m=0.0
aero.flow.generate.cell_m=1e-3
aero.flow.generate.growth=1.0
aero.flow.generate.growth=nan
aero.flow.generate.cells=[10, 10, 10]
aero.flow.generate.core_low_m=[-2000.0, -116.0, 0.0]
aero.flow.generate.core_high_m=[-90.0, 116.0, 235.0]
aero.flow.generate.core_high_m=[1780.0, 116.0, 235.0]
aero.flow.boundaries[4].condition="sea"
wind.speed_m_s=0.0
bodies.float.mass_kg=1e6 : rotor.body
""",
    "validation/naca0012/naca0012.toml": """
aero.flow.grid="nothing.p3d"
aero.flow.grid="/dev/zero"
aero.flow.grid="/etc/hostname" : /etc/hostname
aero.flow.map="/dev/zero"
aero.flow.map="/etc/hostname" : /etc/hostname
aero.flow.boundaries[0].patch="nothing"
aero.flow.turbulence="magic"
aero.flow.incidence_deg="up"
""",
    "validation/naca0012/family.toml": """
aero.flow.generate.kind="aerofoil" : aero.flow.generate.naca
aero.flow.generate.naca="4412"
aero.flow.generate.kind="aerofoil" & aero.flow.generate.naca="NACA 0012" : aero.flow.generate.naca
aero.flow.generate.kind="aerofoil" & aero.flow.generate.naca="012" : aero.flow.generate.naca
aero.flow.generate.kind="aerofoil" & aero.flow.generate.naca="4012" : aero.flow.generate.naca
aero.flow.generate.kind="aerofoil" & aero.flow.generate.naca="21112" : aero.flow.generate.naca
aero.flow.generate.kind="wing" & aero.flow.generate.trailing_edge="open" : aero.flow.generate.trailing_edge
aero.flow.generate.kind="wing" & aero.flow.width_m=2.0 : aero.flow.width_m
""",
    "validation/stl_buoy/stl_buoy.toml": """
bodies.buoy.meshes[0].file="nothing.stl"
bodies.buoy.meshes[0].file="/dev/zero"
bodies.buoy.meshes[0].file="/etc/hostname" : /etc/hostname
bodies.buoy.meshes[0].scale=0.0
bodies.buoy.meshes[0].scale=1000.0 : bodies.buoy
bodies.buoy.meshes[0].scale=0.001 : bodies.buoy
bodies.buoy.meshes[0].position_m=[0.0, 0.0]
sea.tank.meshes[0].file="/dev/zero"
sea.tank.meshes[0].position_m=[100.0, 0.0, 0.0]
sea.tank.meshes[0].water="beside"
sea.particles.walls="modified"
sea.tank.sides_y="symmetric" & sea.tank.y_m=[0.0, 3.0] : bodies.buoy.meshes
sea.particles.dimensions="2" & sea.tank.y_m=[0.0, 0.0] & bodies.buoy.meshes[0].position_m=[0.0, 3.0, 0.0] : bodies.buoy.meshes[0].file
""",
    "validation/floating_box/floating_box.toml": """
sea.tank.sides_x="open" & bodies.box.boxes[0].centre_m=[0.9, 0.0, 0.0] : bodies.box
sea.initial.settle_s=0.0 & sea.initial.settle_damping_1_s=0.0 & sea.initial.state="waves" & waves.model="airy" & waves.height_m=0.05 & waves.period_s=1.0 & sea.tank.bed_m=[[-1.0, -0.6], [1.0, -0.3]] : sea.tank.bed_m
sea.initial.settle_s=0.2 & sea.initial.state="waves" & waves.model="airy" & waves.height_m=0.05 & waves.period_s=1.0 & sea.wavemaker.type="piston" : sea.wavemaker.start_s
waves.model="airy" & waves.height_m=0.05 & waves.period_s=1.0 & sea.wavemaker.type="piston" & sea.water=[{low_m=[-1.0, 0.0, -0.6], high_m=[1.0, 0.0, -0.3]}] : sea.water[0]
waves.model="airy" & waves.height_m=0.05 & waves.period_s=1.0 & sea.initial.settle_damping_1_s=0.0 & sea.damping_zones=[{from_m=0.0, to_m=1.0, rate_1_s=20.0, towards="waves"}] & sea.water=[{low_m=[-1.0, 0.0, -0.6], high_m=[1.0, 0.0, -0.3]}] : sea.damping_zones[0].towards
bodies.box.cylinders=[{name="brace", start_m=[-0.4, -0.2, 0.0], end_m=[0.4, 0.2, 0.0], diameter_m=0.4}] : bodies.box.cylinders[0]
bodies.box.displacement_m=[0.0, 0.1, 0.05]
bodies.box.rotation_deg=[5.0, 0.0, 0.0]
bodies.box.velocity_m_s=[0.0, 0.1, 0.0]
bodies.box.omega_rad_s=[0.0, 0.0, 0.1]
joints.turn={type="revolute", bodies=["earth", "box"], point_m=[0.0, 0.0, 0.0], axis=[1.0, 0.0, 0.0], rotation={speed_rpm=1.0}} : joints.turn.rotation
joints.plane_box={type="planar", bodies=["earth", "box"], point_m=[0.0, 0.0, 0.0], axis=[0.0, 1.0, 0.0]} : joints.plane_box
""",
    "validation/free_sphere/free_sphere.toml": """
sea.tank.sides_y="mirror"
sea.tank.y_m=[0.0, 7.0] & sea.tank.sides_y="symmetric" & bodies.sphere.centre_m=[0.0, 1.0, 0.0] : bodies.sphere.centre_m
sea.tank.y_m=[0.0, 7.0] & sea.tank.sides_y="symmetric" & bodies.sphere.spheres[0].centre_m=[0.0, 0.1, 0.0] : bodies.sphere.spheres[0]
sea.tank.y_m=[0.0, 7.0] & sea.tank.sides_y="symmetric" & bodies.sphere.inertia_kg_m2=[[838.0, 10.0, 0.0], [10.0, 838.0, 0.0], [0.0, 0.0, 838.0]] : bodies.sphere.inertia_kg_m2
sea.tank.y_m=[0.0, 7.0] & sea.tank.sides_y="symmetric" & bodies.sphere.displacement_m=[0.0, 0.1, 0.0] : bodies.sphere.displacement_m
sea.tank.y_m=[0.0, 7.0] & sea.tank.sides_y="symmetric" & bodies.sphere.rotation_deg=[5.0, 0.0, 0.0] : bodies.sphere.rotation_deg
sea.tank.y_m=[0.0, 7.0] & sea.tank.sides_y="symmetric" & bodies.sphere.rotation_deg=[0.0, 0.0, 5.0] : bodies.sphere.rotation_deg
sea.tank.y_m=[0.0, 7.0] & sea.tank.sides_y="symmetric" & bodies.sphere.velocity_m_s=[0.0, 0.1, 0.0] : bodies.sphere.velocity_m_s
sea.tank.y_m=[0.0, 7.0] & sea.tank.sides_y="symmetric" & bodies.sphere.omega_rad_s=[0.1, 0.0, 0.0] : bodies.sphere.omega_rad_s
sea.tank.y_m=[0.0, 7.0] & sea.tank.sides_y="symmetric" & sea.particles.walls="modified" : sea.particles.walls
sea.tank.y_m=[0.0, 7.0] & sea.tank.sides_y="symmetric" & sea.initial.settle_s=0.0 & sea.initial.settle_damping_1_s=0.0 & sea.initial.state="waves" & waves.model="airy" & waves.height_m=0.1 & waves.period_s=2.0 & waves.direction_deg=20.0 : waves.direction_deg
sea.initial.settle_s=0.0 & sea.initial.settle_damping_1_s=0.0 & sea.initial.state="waves" & waves.model="airy" & waves.height_m=0.1 & waves.period_s=2.0 & waves.direction_deg=20.0 : sea.initial.state
sea.tank.y_m=[0.0, 7.0] & sea.tank.sides_y="symmetric" & sea.particles.dimensions="2" & sea.tank.y_m=[0.0, 0.0] : sea.tank.sides_y
sea.tank.y_m=[0.0, 7.0] & sea.tank.sides_y="symmetric" & sea.gauges=[{name="beyond", point_m=[2.0, -1.0]}] : sea.gauges[0]
sea.tank.y_m=[0.0, 7.0] & sea.tank.sides_y="symmetric" & sea.probes=[{name="beyond", point_m=[2.0, -1.0, -1.0]}] : sea.probes[0]
sea.tank.y_m=[0.0, 7.0] & sea.tank.sides_y="symmetric" & sea.sensors=[{name="all_round", body="sphere", low_m=[-1.0, -1.0, -1.0], high_m=[1.0, 1.0, 0.0]}] : sea.sensors[0]
sea.tank.y_m=[0.0, 7.0] & sea.tank.sides_y="symmetric" & sea.sensors=[{name="on_it", low_m=[-1.0, 0.0, -1.0], high_m=[1.0, 0.0, 0.0]}] : sea.sensors[0]
sea.tank.y_m=[0.0, 7.0] & sea.tank.sides_y="symmetric" & joints.turn={type="revolute", bodies=["earth", "sphere"], point_m=[0.0, 0.0, 0.0], axis=[1.0, 0.0, 0.0], rotation={speed_rpm=1.0}} : joints.turn.rotation
sea.tank.y_m=[0.0, 7.0] & sea.tank.sides_y="symmetric" & joints.push={type="translational", bodies=["earth", "sphere"], point_m=[0.0, 0.0, 0.0], axis=[0.0, 1.0, 0.0], translation={speed_m_s=0.1}} : joints.push.translation
sea.tank.y_m=[0.0, 7.0] & sea.tank.sides_y="symmetric" & joints.symmetry_sphere={type="planar", bodies=["earth", "sphere"], point_m=[0.0, 0.0, 0.0], axis=[0.0, 1.0, 0.0]} : joints.symmetry_sphere
""",
    "validation/dam_break/koshizuka_oka.toml": """
sea.particles.dimensions="4"
sea.particles.spacing_m=-1.0
sea.particles.spacing_m=1e-9
sea.tank.top_m=1e12
sea.tank.y_m=[0.0, 1.0]
sea.water[0].low_m=[0.0, 0.0]
sea.gauges[0].name=""
sea.probes[0].point_m=[0.0]
""",
}


def cases():
    for base, lines in TABLE.items():
        for line in filter(None, (line.strip() for line in lines.splitlines())):
            overrides, _, key = line.partition(" : ")
            overrides = [o.strip() for o in overrides.split(" & ")]
            yield base, overrides, key.strip() or overrides[0].split("=", 1)[0]


LONGEST_S = 120  # of which sanitizers need most


def ended(folder, *words, settings):
    begin = time.time()
    try:
        # Open MPI keeps files of its own in TMPDIR, which side by side get in each other's way.
        done = spindrift(*words, settings=settings, timeout=LONGEST_S, env={**os.environ, "TMPDIR": folder}, cwd=folder)
    except subprocess.TimeoutExpired:
        return None, f"still at work after {LONGEST_S} s", time.time() - begin
    return done.returncode, done.stdout + done.stderr, time.time() - begin


def named(key, said):
    """The key, or one around it or in it, in a problem's line."""
    around = {key} | {key[:m.start()] for m in re.finditer(r"[.\[]", key)} - {key.split(".")[0].split("[")[0]}
    return any(one in said for one in around) or key.split(".")[0] == "unknown" and "unknown" in said


def main():
    if not sanitized():  # AddressSanitizer takes terabytes of addresses
        resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))  # of the programs too
    faults, slowest = [], 0.0

    def one(case):
        base, overrides, key = case
        scene = ROOT / "inputs" / base
        with tempfile.TemporaryDirectory(prefix="spindrift_refused_") as folder:
            code, said, seconds = ended(folder, "check", scene, settings=overrides)
            where = f"{base} --set {' --set '.join(overrides)}"
            if code != 2 or not named(key, said):
                return seconds, f"{where}\n  check ended with {code}, must name {key}:\n  " + said.strip()[-600:]
            code, again, _ = ended(folder, "run", scene, "--out", "out", "--no-report", "--quiet", "--until", "0", settings=overrides)
            if code != 2 or not named(key, again):
                return seconds, f"{where}\n  check refuses it, run ended with {code}:\n  " + again.strip()[-600:]
        return seconds, None

    all_cases = list(cases())
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for seconds, fault in pool.map(one, all_cases):
            slowest = max(slowest, seconds)
            if fault:
                faults.append(fault)
    print("\n".join(faults))
    print(f"refused scenes: {len(all_cases) - len(faults)} of {len(all_cases)} as expected; the slowest check took {slowest:.1f} s")
    if len(all_cases) < 200:
        faults.append("fewer than 200 cases")
    sys.exit(1 if faults else 0)


main()
