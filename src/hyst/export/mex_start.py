"""What MATLAB and Octave start a state with, where a history of the drive can be followed."""

from __future__ import annotations

from hyst.export.c.block import Block


def start_texts(block: Block, name: str) -> dict[str, str]:
    """Give what gateway, object and README need for a start after a history.

    Parameters
    ----------
    block
        What is exported.
    name
        Of the function.
    """
    if block.following is None:
        none = dict.fromkeys(("start_in_c", "start_in_m", "start_in_readme", "start_call"), "")
        return none | {"others": "2"}
    beyond = "is not finite"
    meanwhile = ""
    if block.drive.limits is not None:
        low, high = block.drive.limits
        beyond += f" or not from {low:.9g} to {high:.9g}"
    second = block.inputs[1] if block.second else ""
    more = f", {second}" if second else ""
    given = "drives, mxGetNumberOfElements(prhs[1])"
    there = "after an actuator's".rjust(32 - len(more))
    taken = ""
    if second:
        beyond += f", or {second} is not"
        meanwhile = f" {second} is the second signal then, one value."
        taken, given = _taken(second), f"{given}, *{second}"
    return {
        "others": 'strcmp(command, "after") == 0 ? 3 : 2' if second else "2",
        "start_call": f" *   state = {name}_mex('after', drives{more}){there}\n",
        "start_in_c": f"""    if (strcmp(command, "after") == 0) {{
        const double *const drives = hyst_mex_vector(prhs[1], "drives");
{taken}        if ({name}_init_after(&state, {given}) != 0) {{
            mexErrMsgIdAndTxt("hyst:input", "one of the drives {beyond}; "
                                            "pass those that the actuator has had.");
        }}
        plhs[0] = hyst_mex_give_state(&state);
        return;
    }}
""",
        "start_in_m": f"""        function init_after(self, drives{more})
            % Starts anew after what drove the actuator, in time order: where it turned is enough
            % unless time counts.{meanwhile}
            self.state = {name}_mex('after', drives{more});
        end
""",
        "start_in_readme": f"    object.init_after([...]{more});".ljust(40)
        + "% starts after these drives\n",
    }


def _taken(second: str) -> str:
    """Give C that takes the one value of a ``second`` signal."""
    return f"""        const double *const {second} = hyst_mex_vector(prhs[2], "{second}");
        if (mxGetNumberOfElements(prhs[2]) != 1) {{
            mexErrMsgIdAndTxt("hyst:input", "{second} is a record; pass the one value it had.");
        }}
"""
