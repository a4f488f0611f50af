"""`kurbel schema`: the JSON Schema of the machine file."""

import click


@click.command()
@click.option("--answers", is_flag=True, help="The schema of what -f json prints instead, for programs.")
@click.option("--output", "-o", "file_name", metavar="FILE", help="Write to this file instead of standard output.")
def schema(answers: bool, file_name: str | None) -> None:
    """Print the JSON Schema (draft-07) of the machine file; editors complete and check with it.

    \b
      kurbel schema > kurbel.schema.json
      first line of a machine file:
      # yaml-language-server: $schema=./kurbel.schema.json
    """
    import json

    from kurbel.machine_file.schema import json_schema
    from kurbel.render.data import answer_schema
    from kurbel.render.output import write_out

    # escapes instead of Greek: valid in whatever encoding a shell redirects to
    text = json.dumps(answer_schema() if answers else json_schema(), indent=2, allow_nan=False) + "\n"
    write_out((text,), file_name, "utf-8")
