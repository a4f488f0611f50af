"""Machine files that read well: for the tests of the reader, of the schema, and as seeds of the fuzz."""

from __future__ import annotations

DEMO = """\
name: Demo steam engine
speed: 50 rpm
crank: 400 mm              # or stroke: 800 mm
rod: 2000 mm               # or rod_ratio: 5  (L/R)
bore: 450 mm
indicator:
  head_end:
    unit: at
    expansion:   [[0, 9.5], [0.35, 9.5], [0.5, 6.7], [0.7, 4.7], [0.95, 3.3], [1, 2.2]]
    compression: [[1, 1.2], [0.25, 1.2], [0.1, 2.4], [0.02, 6.5], [0, 9.5]]
  crank_end: mirrored
"""
FULL = """\
kurbel: 1
name: Everything
speed: 50 rpm
cycle: two-stroke
efficiency: 0.9
ambient: 1 bar
cylinders:
  - name: HP
    stroke: 800 mm
    rod_ratio: 5
    offset: 0 mm
    inclination: 90 deg
    bore: 450 mm
    head_end_rod: 75 mm
    crank_end_rod: 100 mm
    indicator:
      pressures: gauge
      head_end:
        steam: {admission: 8 bar, exhaust: 0.2 bar, cut_off: 0.3, clearance: 0.05, compression: 0.1}
      crank_end: mirrored
    tandem:
      - bore: 285 mm
        indicator:
          head_end:
            constant: {expansion: -0.45 at, compression: 5.4 at}
    masses:
      piston: [122 kg, 282 kg]
      piston_rod: 122 kg
      crosshead: 190 kg
      other: 1 kg
      connecting_rod: {mass: 220 kg, share: 0.5}
    friction:
      crosshead: 0.1
      rings: {count: 3, height: 20 mm, pressure: 0.2 bar, coefficient: 0.08}
  - name: LP
    mechanism: slider-crank
    crank: 400 mm
    rod: infinite
    crank_position: 90 deg
    bore: 700 mm
    indicator:
      pressures: absolute
      head_end:
        trace: {unit: bar, points: [[0, 3], [180, 1], [180, 0.9], [360, 3]]}
flywheel: {gd2: 40000 kgf m2, fluctuation: 0.01}
load: {power_law: 2}
coupling: {stiffness: 1000 kN m/rad, damping: 10 N m s/rad, inertia: 500 kg m2}
crankshaft:
  a: 400 mm
  b: 400 mm
  web_distance: 100 mm
  web_thickness: 60 mm
  web_width: 90 mm
  pin_diameter: 100 mm
  pin_length: 90 mm
  journal_diameter: 110 mm
  journal_length: 150 mm
  flywheel_mass: 3 t
  flywheel_position: 200 mm
  allowable_bending: 60 N/mm2
  allowable_torsion: 40 MPa
limits:
  c_max: 6 m/s
  delta: 1/200
"""
GAS_ENGINE = """\
cycle: four-stroke
crank: 100 mm
rod_ratio: 4
bore: 150 mm
indicator:
  head_end:
    otto: {intake: -0.1 bar, exhaust: 0.1 bar, peak: 25 bar, compression_ratio: 5}
load: {slip: 0.02}
flywheel: {inertia: 12 kg m2}
"""
DIESEL = """\
cycle: four-stroke
crank: 100 mm
rod_ratio: 4
bore: 150 mm
indicator:
  head_end:
    diesel: {intake: 0 bar, exhaust: 0 bar, clearance: 0.07, cut_off: 0.1, peak: 45 bar, exponent: 1.35}
load:
  unit: N m
  points: [[0, 100], [90, 100], [90, 500], [720, 100]]
"""
COMPRESSOR = """\
crank: 150 mm
rod: 750 mm
bore: 300 mm
indicator:
  head_end:
    compressor: {suction: 0 bar, delivery: 4 bar, clearance: 0.05}
"""
EFFORT = "effort: {unit: kgf m, points: [[0, 0], [90, 300], [360, 0]]}\nload: constant\nspeed: 100 1/min\n"
EQUAL = """\
cycle: four-stroke
cylinders:
  count: 4
  firing_order: 1-3-4-2
  spacing: 96 mm
  bank_angles: [0 deg, 180 deg]
  each: {crank: 100 mm, rod_ratio: 4, bore: 150 mm}
"""
LIKE_ONE = """\
firing_order: 1-2
cylinders:
  - {name: A, crank: 100 mm, rod_ratio: 4, axial_position: 0 mm}
  - {like: A, axial_position: 90 mm, bank_angle: 90 deg}
"""
SHAFT_LINE = """\
crank: 100 mm
rod_ratio: 4
flywheel: {inertia: 3 kg m2}
shaft:
  - {cylinder: [cylinder 1], inertia: 1 kg m2, damping: 2 N m s/rad}
  - {stiffness: 200 kN m/rad, diameter: 60 mm, loss_factor: 1 %}
  - flywheel
  - {diameter: 60 mm, bore: 20 mm, length: 400 mm, shear_modulus: 80 GPa, damping: 3 N m s/rad}
  - {name: pinion, inertia: 0.1 kg m2}
  - {gear: 1/2}
  - {name: wheel, inertia: 0.4 kg m2, load: true}
  - {diameter: 60 mm, length: 400 mm}
  - ground
"""
BALANCED = """\
speed: 250 rpm
counterweights: {share: 1/3, planes: [-750 mm, 750 mm]}
balance_shafts:
  - {order: 2, sense: against, mass: 2 kg, radius: 30 mm, angle: 90 deg, axial_position: 0 mm}
locomotive: {wheel_distance: 1.5 m, wheel_diameter: 1.98 m, wheel_load: 8 tf, hammer_limit: 25 kN}
moment_reference: 0 mm
cylinders:
  - {name: A, crank: 300 mm, rod_ratio: 8.5, axial_position: -1 m, masses: {other: 290 kg, rotating: 210 kg}}
  - {like: A, axial_position: 1 m, crank_position: 90 deg, counterweights: [{product: 2 kg m, angle: 170 deg}]}
"""
ALL = {
    "demo": DEMO,
    "full": FULL,
    "gas engine": GAS_ENGINE,
    "diesel": DIESEL,
    "compressor": COMPRESSOR,
    "effort": EFFORT,
    "equal cylinders": EQUAL,
    "like one": LIKE_ONE,
    "shaft line": SHAFT_LINE,
    "balanced": BALANCED,
}
