(* SPDX-License-Identifier: Apache-2.0 *)
(** Prints what the theorems rest on, and writes the checker as OCaml over the integers of [integer.ml]. *)
From Certificates Require Import statement checker soundness axes directed bounds.
Require Import ZArith Extraction ExtrOcamlBasic.

Print Assumptions accepted_holds.
Print Assumptions axes_decide.
Print Assumptions axes_one_sided.
Print Assumptions one_side_or_boxes.
Print Assumptions seventeen_axes.
Print Assumptions two_axes_decide.
Print Assumptions directed_is_exhaustive.
Print Assumptions error_of_sign.
Print Assumptions sign_certain.
Print Assumptions gap_certain.
Print Assumptions eta_of_rounding.
Print Assumptions widths_suffice.

Extract Inductive positive => "Integer.t"
  [ "Integer.twice_plus_one" "Integer.twice" "Integer.one" ] "Integer.cases_of_positive".
Extract Inductive Z => "Integer.t" [ "Integer.zero" "" "Integer.neg" ] "Integer.cases".
Extract Inlined Constant Z.add => "Integer.add".
Extract Inlined Constant Z.sub => "Integer.sub".
Extract Inlined Constant Z.mul => "Integer.mul".
Extract Inlined Constant Z.opp => "Integer.neg".
Extract Inlined Constant Z.min => "Integer.min".
Extract Inlined Constant Z.max => "Integer.max".
Extract Inlined Constant Z.eqb => "Integer.equal".
Extract Inlined Constant Z.leb => "Integer.leq".
Extract Inlined Constant Z.ltb => "Integer.lt".
Extract Inlined Constant Z.shiftl => "Integer.shift".
Extract Inductive nat => "int" [ "0" "succ" ]
  "(fun f_zero f_next n -> if n = 0 then f_zero () else f_next (n - 1))".

Extraction "checked.ml" prepare trees_of check_prepared.
