"""Options of the commands that tell of orders: which ones, and at which speeds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from kurbel.cli.output_options import Numbers

if TYPE_CHECKING:
    _SpeedsType = click.ParamType[tuple[float, ...]]
else:  # before click 8.4 a ParamType has no parameter
    _SpeedsType = click.ParamType

_MOST = 10_000


class Speeds(_SpeedsType):
    """Speeds of rotation with one unit, such as `300, 350 rpm`, or `300:1500:10 rpm`, from, to, step."""

    name = "speeds"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[float, ...]:
        """Return the speeds in revolutions per second, in the order given."""
        if not isinstance(value, str):
            return tuple(value)
        from kurbel.declared.units import unit_factor, written_unit
        from kurbel.errors import UnitError

        *first, last = value.replace(":", ",").split(",")
        unit = written_unit(last)
        try:
            up, down = unit_factor(unit, "speed") if unit else (0.0, 1.0)
            texts = [*first, last.strip().removesuffix(unit)]
            numbers = [number * up / down for number in Numbers().convert(",".join(texts), param, ctx)]
        except UnitError as error:
            self.fail(str(error), param, ctx)
        if not unit:
            self.fail(f"'{value}' has no unit; write it with one, such as '{value} rpm'", param, ctx)
        speeds = self._stepped(numbers, value, param, ctx) if ":" in value else tuple(numbers)
        if not all(speed > 0 for speed in speeds):
            self.fail(f"'{value}': a speed is more than 0", param, ctx)
        return speeds

    def _stepped(self, numbers: list[float], value: str, *place: Any) -> tuple[float, ...]:
        if len(numbers) != 3 or "," in value or not numbers[2] > 0 or numbers[1] < numbers[0]:
            self.fail(f"'{value}': write from, to and step as '300:1500:10 rpm'", *place)
        low, high, step = numbers
        count = (high - low) / step
        if count > _MOST:
            self.fail(f"'{value}': more than {_MOST} speeds; take a larger step", *place)
        return tuple(low + step * index for index in range(int(count + 1e-9) + 1))


orders_option = click.option(
    "--orders",
    type=Numbers(),
    metavar="A,B,...",
    help="Only these orders, periods per turn of the shaft; all up to 24 if not given.",
)
speeds_option = click.option(
    "--speeds", type=Speeds(), metavar="'A,B,... rpm'", help="Also at these speeds; or 'FROM:TO:STEP rpm'."
)
