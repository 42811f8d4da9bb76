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
        return {"start_in_c": "", "start_in_m": "", "start_in_readme": "", "start_call": ""}
    beyond = "is not finite"
    if block.drive.limits is not None:
        low, high = block.drive.limits
        beyond += f" or not from {low:.9g} to {high:.9g}"
    return {
        "start_call": f" *   state = {name}_mex('after', drives)             after an actuator's\n",
        "start_in_c": f"""    if (strcmp(command, "after") == 0) {{
        const double *const drives = hyst_mex_vector(prhs[1], "drives");
        if ({name}_init_after(&state, drives, mxGetNumberOfElements(prhs[1])) != 0) {{
            mexErrMsgIdAndTxt("hyst:input", "one of the drives {beyond}; "
                                            "pass those that the actuator has had.");
        }}
        plhs[0] = hyst_mex_give_state(&state);
        return;
    }}
""",
        "start_in_m": f"""        function init_after(self, drives)
            % Starts anew after what drove the actuator, in time order: where it turned is enough
            % unless time counts.
            self.state = {name}_mex('after', drives);
        end
""",
        "start_in_readme": "    object.init_after([...]);           % starts after these drives\n",
    }
