"""Formulas of Appeltans et al. (2014) as printed, in the symbols of `kuleuven2014_truth.symbols`.

Both here and in studies/kuleuven2014/errors.csv they are plain text in the same symbols: T1, T2,
vectors and cross products as in the publication; m_D, J_x, J_y, J_z and m_C, I_x, I_y, I_z the
masses and principal moments of leg and wheel; L_x, L_y, L_z of the wheel, leg axes; G_D, G_C the
weights; dL_D, dL_C the rates of angular momentum. @ multiplies matrices.
"""

# As printed: (equation, quantity) -> the whole formula, of which the table quotes the wrong term.
X_C, Z_C = "(-l3*sin(beta) - l4*cos(beta))", "(-l3*cos(beta) + l4*sin(beta))"
X_D, Z_D = "(-l4*cos(beta)/4 - 3*l3*sin(beta)/4)", "(l4*sin(beta)/4 - 3*l3*cos(beta)/4)"
OUT = "(l1 - l3*sin(beta) - l4*cos(beta))"
SPINNING = "rate of omega of the wheel"
PRINTED = {
    ("1", "omega of the wheel, z'"): "omega_g - omega_w*sin(beta)",
    (
        "2",
        "alpha of the wheel, x'",
    ): "-omega_g*omega_i + alpha_w*cos(beta) + omega_i*omega_w*sin(beta)",
    (
        "2",
        "alpha of the wheel, z'",
    ): "alpha_g - alpha_w*sin(beta) + omega_i*omega_w*cos(beta)",
    (
        "2",
        "alpha of the wheel, world z",
    ): "(alpha_i - omega_g*omega_w*cos(beta)*sin(alpha))"
    " + (alpha_g - alpha_w*sin(beta) + omega_i*omega_w*cos(beta))*cos(alpha)",
    ("below 2", "rate of e_x''' times -omega_w, y'"): "omega_g*omega_w*cos(beta)",
    ("5", "r_AC, z'"): "l2 - l3*cos(beta) + l4*cos(beta)",
    ("13", "a_C, y'"): "(a_A + cross(yaw_rate, r_AC) + cross(fold_rate, r_BC)"
    " + cross(yaw, v_C - v_A) + cross(fold, v_C - v_B))[1]",
    ("24", "a_C, world y"): f"alpha_g*cos(alpha)*{OUT} + alpha_i*sin(alpha)*{X_C}"
    f" + a_v*cos(alpha) + omega_g*omega_i*cos(alpha)*{Z_C} + omega_i**2*sin(alpha)*{Z_C}",
    ("24", "a_C, world z"): f"alpha_g*sin(alpha)*{OUT} - alpha_i*cos(alpha)*{X_C}"
    f" + a_v*sin(alpha) - omega_g*omega_i*sin(alpha)*{Z_C} - omega_i**2*cos(alpha)*{Z_C}",
    ("26", "Coriolis part of a_C, y'"): f"-2*omega_g*omega_i*{Z_C}",
    ("26", "Coriolis part of a_C, world y"): f"-2*omega_g*omega_i*{Z_C}*cos(beta)",
    ("26", "Coriolis part of a_C, world z"): f"-2*omega_g*omega_i*{Z_C}*cos(beta)",
    ("38", "a_D seen from x''y''z'', y''"): f"omega_g*omega_i*{Z_D}",
    ("38", "a_D seen from x''y''z'', z''"): f"-alpha_i*{X_D} + omega_i**2*{X_D}",
    ("40", "a_D, x'"): f"-omega_g**2*l1 + omega_g**2*{X_D} + alpha_i*{Z_D} - omega_i**2*{X_D}",
    (
        "40",
        "a_D, y'",
    ): f"a_v + alpha_g*l1 + alpha_g*{X_D} + 3*omega_g*omega_i*{Z_D}",
    ("40", "a_D, z'"): f"-alpha_i*{X_D} + omega_i**2*{X_D}",
    ("42", "p_D, world z"): f"m_D*((v_v + omega_g*l1 + omega_g*{X_D})*sin(alpha)"
    f" + cos(alpha)*omega_i*{X_D})",
    ("46", "matrix from world to leg axes"): "inv(T1) @ inv(T2)",
    ("47 and 55", "matrix from leg axes to world"): "T2 @ T1",
    (
        "49",
        "Omega x L of the wheel, y'''",
    ): "omega_g*cos(beta)*L_x + (omega_w + omega_g)*L_z",
    (
        "49",
        "Omega x L of the wheel, z'''",
    ): "-(omega_w + omega_g*sin(beta))*L_y + omega_i*L_x",
    ("50", f"{SPINNING}, x'''"): "alpha_w - alpha_g*sin(beta) - omega_i*omega_g*cos(beta)",
    ("50", f"{SPINNING}, y'''"): "alpha_i + omega_g*omega_w*cos(beta)",
    (
        "50",
        f"{SPINNING}, z'''",
    ): "alpha_g*cos(beta) - omega_i*omega_g*sin(beta) - omega_i*omega_w",
    ("51", f"{SPINNING}, x'''"): "alpha_w - alpha_g - omega_i*omega_g*cos(beta)",
    ("51", f"{SPINNING}, y'''"): "alpha_i + cos(beta)*omega_g*omega_w",
    (
        "51",
        f"{SPINNING}, z'''",
    ): "alpha_g*cos(beta) - omega_i*omega_g*sin(beta) - omega_i*omega_g",
    ("52", "rate of L of the wheel, x'''"): "omega_i*omega_g*cos(beta)*(I_z - I_y)"
    " + I_x*(alpha_w - alpha_g*sin(beta) - omega_i*omega_g)*cos(beta)",
    (
        "52",
        "rate of L of the wheel, y'''",
    ): "omega_g*cos(beta)*(omega_w + omega_g*sin(beta))*(I_z - I_x)"
    " + I_y*(alpha_i + omega_g*omega_w*cos(beta))",
    (
        "52",
        "rate of L of the wheel, z'''",
    ): "(omega_i + omega_g*sin(beta))*omega_i*(I_x - I_y)"
    " + I_z*(alpha_g*cos(beta) - omega_i*omega_g*sin(beta) - omega_i*omega_w)",
    ("58", "Omega x L of the leg, y'''"): "omega_g*cos(beta)*sin(beta)*(J_z - J_x)",
    (
        "59",
        "rate of L of the leg, y'''",
    ): "omega_g*cos(beta)*sin(beta)*(J_z - J_x) + alpha_i*J_y",
    ("64", "F_B"): "m_D*a_D + m_C*a_C - G_D - G_C",
    ("65", "rate of L_B of the leg"): "dL_D + cross(r_BD, m_D*a_D)",
    ("66", "r_BD, world x"): "cos(beta)*(3*l3*sin(beta)/4 - l4*cos(beta)/4)"
    " + cos(alpha)*sin(beta)*(-3*l3*cos(beta)/4 + l4*sin(beta)/4)",
    ("66", "r_BD, world y"): "-sin(alpha)*(-3*l3*sin(beta)/4 + l4*cos(beta)/4)",
    ("66", "r_BD, world z"): "sin(beta)*(-3*l3*sin(beta)/4 + l4*cos(beta)/4)"
    " + cos(alpha)*cos(beta)*(-3*l3*sin(beta)/4 + l4*cos(beta)/4)",
    ("67", "r_BC, world x"): "cos(beta)*(l3*sin(beta) - l4*cos(beta))"
    " + cos(alpha)*sin(beta)*(-l3*cos(beta) + l4*sin(beta))",
    ("67", "r_BC, world z"): "sin(beta)*(-l3*sin(beta) + l4*cos(beta))"
    " + cos(alpha)*cos(beta)*(-l3*cos(beta) + l4*sin(beta))",
    ("68", "M_B"): "dL_D + cross(r_BD, m_D*a_D) + cross(r_BC, m_C*a_C) + dL_C"
    " + cross(r_BD, G_D) + cross(r_BC, G_C)",
}

# As printed, and right: (equation, quantity) -> the whole.
HOLD = {
    ("1", "omega of the wheel, world y"): "-omega_g*sin(alpha) + omega_i*cos(alpha)"
    " - omega_w*sin(alpha)*sin(beta)",
    ("1", "omega of the wheel, world z"): "omega_g*cos(alpha) + omega_i*sin(alpha)"
    " + omega_w*cos(alpha)*sin(beta)",
    ("2", "alpha of the wheel, y'"): "alpha_i - omega_g*omega_w*cos(beta)",
    ("3", "r_AC, z'"): "l2 - l3*cos(beta) + l4*sin(beta)",
    ("4", "r_BC, x'"): X_C,
    ("19", "v_C - v_A, world y"): f"cos(alpha)*omega_g*{OUT} + sin(alpha)*omega_i*{X_C}",
    ("19", "v_C - v_A, world z"): f"sin(alpha)*omega_g*{OUT} - cos(alpha)*omega_i*{X_C}",
    ("22", "v_B, world z"): "sin(alpha)*(v_v + l1*omega_g)",
    ("24", "a_C, world x"): f"alpha_i*{Z_C} - omega_g**2*{OUT} - omega_i**2*{X_C}",
    ("33", "v_D, world x"): f"omega_i*{Z_D}",
    ("33", "v_D, world y"): f"(v_v + omega_g*(l1 + {X_D}))*cos(alpha) + sin(alpha)*omega_i*{X_D}",
    ("33", "v_D, world z"): f"(v_v + omega_g*(l1 + {X_D}))*sin(alpha) - cos(alpha)*omega_i*{X_D}",
    ("35", "a_B, x'"): "-omega_g**2*l1",
    ("35", "a_B, y'"): "a_v + alpha_g*l1",
    ("38", "a_D seen from x''y''z'', x''"): f"alpha_i*{Z_D} - omega_i**2*{X_D}",
    ("42", "p_D, world y"): f"m_D*((v_v + omega_g*(l1 + {X_D}))*cos(alpha)"
    f" + sin(alpha)*omega_i*{X_D})",
    ("47", "L of the wheel, x'''"): "I_x*(-omega_w - omega_g*sin(beta))",
    ("49", "Omega x L of the wheel, x'''"): "omega_i*L_z - omega_g*cos(beta)*L_y",
    ("55", "L of the leg, x'''"): "-J_x*omega_g*sin(beta)",
    ("58", "Omega x L of the leg, x'''"): "omega_i*omega_g*cos(beta)*(J_z - J_y)",
    ("58", "Omega x L of the leg, z'''"): "omega_i*omega_g*sin(beta)*(J_x - J_y)",
    ("59", "rate of L of the leg, x'''"): "omega_i*omega_g*cos(beta)*(J_z - J_y)"
    " + J_x*(-alpha_g*sin(beta) - omega_i*omega_g*cos(beta))",
    ("59", "rate of L of the leg, z'''"): "omega_i*omega_g*sin(beta)*(J_x - J_y)"
    " + J_z*(alpha_g*cos(beta) - omega_i*omega_g*sin(beta))",
    ("67", "r_BC, world y"): f"-sin(alpha)*{Z_C}",
}

# Those of the publication that hold, put right; primed axes.
RIGHT = {
    "v_C": f"(omega_i*{Z_C}, v_v + omega_g*{OUT}, -omega_i*{X_C})",
    "a_C": f"(alpha_i*{Z_C} - omega_g**2*{OUT} - omega_i**2*{X_C},"
    f" a_v + alpha_g*{OUT} + 2*omega_g*omega_i*{Z_C}, -alpha_i*{X_C} - omega_i**2*{Z_C})",
    "v_D": f"(omega_i*{Z_D}, v_v + omega_g*(l1 + {X_D}), -omega_i*{X_D})",
    "wheel_omega": "(-omega_w*cos(beta), omega_i, omega_g + omega_w*sin(beta))",
}
