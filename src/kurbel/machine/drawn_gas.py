"""The gas that a compressor draws in, as an ideal one."""

from kurbel.declared.record import Record, alternative, field

GAS_CONSTANT = 8.31446261815324
"""J/(mol K)."""


class Gas(Record):
    """The gas that a compressor draws in, as an ideal one; what is None is left out, or as in the whole machine."""

    inlet_temperature: float = field(
        "temperature",
        "Temperature of the gas where it is drawn in",
        "T_1",
        above=0,
        example="20 °C",
    )
    gas_constant: float | None = field(
        "gas_constant",
        "Specific gas constant; or give `molar_mass`",
        "R",
        above=0,
        absent="that of the machine's `gas`, else mass flows left out",
        example="287 J/(kg K)",
    )
    _molar_mass = alternative(
        "molar_mass",
        "Molar mass, which gives the gas constant",
        "M",
        above=0,
        instead="gas_constant",
        gives=lambda values: {"gas_constant": GAS_CONSTANT / values["molar_mass"]},
    )
    isentropic_exponent: float | None = field(
        "ratio",
        "Exponent of the compression without heat, c_p/c_v",
        "κ",
        above=1,
        most=10,
        absent="that of the machine's `gas`, else isentropic power left out",
        example="1.4",
    )

    @property
    def mass_of_mole(self) -> float | None:
        """Its molar mass in kg/mol."""
        if self.gas_constant is None:
            return None
        return GAS_CONSTANT / self.gas_constant
