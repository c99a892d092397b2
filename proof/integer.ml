(* SPDX-License-Identifier: Apache-2.0 *)
(* The integers of the extracted checker: those of zarith. extract.v says which function of Coq becomes which of these. *)
type t = Z.t

let zero = Z.zero
let one = Z.one
let twice_plus_one n = Z.succ (Z.shift_left n 1)
let twice n = Z.shift_left n 1
let neg = Z.neg
let add = Z.add
let sub = Z.sub
let mul = Z.mul
let min = Z.min
let max = Z.max
let equal = Z.equal
let leq = Z.leq
let lt = Z.lt

(* Coq's Z.shiftl: a shift by a negative number goes right, rounded down. *)
let shift n by =
  let by = Z.to_int by in
  if by >= 0 then Z.shift_left n by else Z.shift_right n (-by)

let cases_of_positive odd even one p =
  if Z.equal p Z.one then one ()
  else
    let half = Z.shift_right p 1 in
    if Z.is_odd p then odd half else even half

let cases zero positive negative n =
  let sign = Z.sign n in
  if sign = 0 then zero () else if sign > 0 then positive n else negative (Z.neg n)
