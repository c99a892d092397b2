(* SPDX-License-Identifier: Apache-2.0 *)
(** Bounds on rounding errors and widths of the axis pipeline (docs/develop/architecture.md, "Certainty" and "Numbers").
    The Makefile makes [widths.v] of rtl/include/cchip_defs.vh. *)
Require Import ZArith QArith Qabs Lqa Lia List.
From Certificates Require Import statement geometry gordan axes widths.
Import ListNotations.
Open Scope Q_scope.

Definition within (k : Q) (p : point) : Prop := (- k <= x p <= k) /\ (- k <= y p <= k) /\ (- k <= z p <= k).
Definition norm1 (p : point) : Q := Qabs (x p) + Qabs (y p) + Qabs (z p).
Definition plus (p q : point) : point := Triple (x p + x q) (y p + y q) (z p + z q).
(** det(a, b, c): the projection of c on the axis a x b *)
Definition det (a b c : point) : Q := dotq (cofactors a b) c.

(** * Norms *)

Lemma abs_bounds a : - Qabs a <= a /\ a <= Qabs a /\ 0 <= Qabs a.
Proof.
  split; [| split; [apply Qle_Qabs | apply Qabs_nonneg]]. pose proof (Qle_Qabs (- a)) as H. rewrite Qabs_opp in H. lra.
Qed.
Lemma mul_bound A k a v : - A <= a -> a <= A -> - k <= v -> v <= k -> - (A * k) <= a * v /\ a * v <= A * k.
Proof. intros. nra. Qed.
Lemma within_nonneg k p : within k p -> 0 <= k.
Proof. intros ((H & G) & _). lra. Qed.

Lemma dot_norm u v k : within k v -> - (norm1 u * k) <= dotq u v /\ dotq u v <= norm1 u * k.
Proof.
  intros ((X1 & X2) & (Y1 & Y2) & (Z1 & Z2)). unfold dotq, norm1.
  destruct (abs_bounds (x u)) as (A1 & A2 & _), (abs_bounds (y u)) as (B1 & B2 & _), (abs_bounds (z u)) as (C1 & C2 & _).
  pose proof (mul_bound _ _ _ _ A1 A2 X1 X2). pose proof (mul_bound _ _ _ _ B1 B2 Y1 Y2).
  pose proof (mul_bound _ _ _ _ C1 C2 Z1 Z2). lra.
Qed.

Lemma abs_difference a b c d : Qabs (a * b - c * d) <= Qabs a * Qabs b + Qabs c * Qabs d.
Proof.
  apply Qabs_Qle_condition.
  destruct (abs_bounds a) as (A1 & A2 & _), (abs_bounds b) as (B1 & B2 & _),
    (abs_bounds c) as (C1 & C2 & _), (abs_bounds d) as (D1 & D2 & _).
  pose proof (mul_bound _ _ _ _ A1 A2 B1 B2). pose proof (mul_bound _ _ _ _ C1 C2 D1 D2). lra.
Qed.
Lemma cross_norm a b : norm1 (cofactors a b) <= norm1 a * norm1 b.
Proof.
  unfold norm1, cofactors; cbn [x y z].
  pose proof (abs_difference (y a) (z b) (z a) (y b)). pose proof (abs_difference (z a) (x b) (x a) (z b)).
  pose proof (abs_difference (x a) (y b) (y a) (x b)).
  assert (forall s t, 0 <= Qabs s * Qabs t) as P by (intros; apply Qmult_le_0_compat; apply Qabs_nonneg).
  pose proof (P (x a) (x b)). pose proof (P (y a) (y b)). pose proof (P (z a) (z b)). lra.
Qed.
Lemma within_cross j k a b : within j a -> within k b -> within (2 * j * k) (cofactors a b).
Proof.
  intros ((X1 & X2) & (Y1 & Y2) & (Z1 & Z2)) ((X3 & X4) & (Y3 & Y4) & (Z3 & Z4)). unfold within, cofactors; cbn [x y z].
  pose proof (mul_bound _ _ _ _ Y1 Y2 Z3 Z4). pose proof (mul_bound _ _ _ _ Z1 Z2 Y3 Y4).
  pose proof (mul_bound _ _ _ _ Z1 Z2 X3 X4). pose proof (mul_bound _ _ _ _ X1 X2 Z3 Z4).
  pose proof (mul_bound _ _ _ _ X1 X2 Y3 Y4). pose proof (mul_bound _ _ _ _ Y1 Y2 X3 X4). repeat split; lra.
Qed.
Lemma within_norm k p : within k p -> norm1 p <= 3 * k.
Proof.
  intros (X & Y & Z). unfold norm1. apply Qabs_Qle_condition in X, Y, Z. lra.
Qed.

(** The corner of the cube in which a product with p is greatest *)
Lemma sign_of a : exists s, (s == 1 \/ s == - (1)) /\ Qabs a == s * a.
Proof.
  destruct (Qlt_le_dec a 0).
  - exists (- (1)). split; [right; reflexivity |]. rewrite Qabs_neg; lra.
  - exists 1. split; [left; reflexivity |]. rewrite Qabs_pos; lra.
Qed.
Definition corner (s : point) : Prop := (x s == 1 \/ x s == - (1)) /\ (y s == 1 \/ y s == - (1)) /\ (z s == 1 \/ z s == - (1)).
Lemma norm_corner p : exists s, corner s /\ norm1 p == dotq s p.
Proof.
  destruct (sign_of (x p)) as (a & A & A'), (sign_of (y p)) as (b & B & B'), (sign_of (z p)) as (c & C & C').
  exists (Triple a b c). split; [split; auto |]. unfold norm1, dotq; cbn. lra.
Qed.
Lemma corner_cross s k b : corner s -> within k b -> norm1 (cofactors b s) <= 4 * k.
Proof.
  intros (X & Y & Z) (Bx & By & Bz). destruct (norm_corner (cofactors b s)) as (t & (Tx & Ty & Tz) & ->).
  unfold dotq, cofactors; cbn [x y z].
  destruct X as [-> | ->], Y as [-> | ->], Z as [-> | ->], Tx as [-> | ->], Ty as [-> | ->], Tz as [-> | ->]; lra.
Qed.
(** Hadamard's 4 of a matrix of +1 and -1, for vectors *)
Lemma cross_of_cube j k a b : within j a -> within k b -> norm1 (cofactors a b) <= 4 * j * k.
Proof.
  intros A B. destruct (norm_corner (cofactors a b)) as (s & S & ->).
  assert (dotq s (cofactors a b) == dotq (cofactors b s) a) as -> by coordinates.
  pose proof (dot_norm (cofactors b s) a j A) as (_ & H). pose proof (corner_cross s k b S B).
  pose proof (within_nonneg j a A). nra.
Qed.
Lemma det_of_cube i j k a b c : within i a -> within j b -> within k c -> - (4 * i * j * k) <= det a b c <= 4 * i * j * k.
Proof.
  intros A B C. pose proof (dot_norm (cofactors a b) c k C) as H. pose proof (cross_of_cube i j a b A B).
  pose proof (within_nonneg k c C). unfold det. split; nra.
Qed.

(** * The error of a sign, of a projection on a fixed axis, of rounding *)

Theorem error_of_sign eta a b c dx dy dz : within eta dx -> within eta dy -> within eta dz ->
  Qabs (det (plus a dx) (plus b dy) (plus c dz) - det a b c)
  <= eta * (norm1 (cofactors a b) + (norm1 a + norm1 b + 2 * eta) * (norm1 c + 2 * eta)).
Proof.
  intros X Y Z. apply Qabs_Qle_condition.
  assert (det (plus a dx) (plus b dy) (plus c dz) - det a b c
    == dotq (cofactors a b) dz + dotq (cofactors b c) dx - dotq (cofactors a c) dy
       + dotq c (cofactors dx dy) + dotq b (cofactors dz dx) + dotq a (cofactors dy dz) + det dx dy dz) as ->.
  { unfold det, plus. coordinates. }
  pose proof (dot_norm (cofactors a b) dz eta Z). pose proof (dot_norm (cofactors b c) dx eta X).
  pose proof (dot_norm (cofactors a c) dy eta Y).
  pose proof (dot_norm c _ _ (within_cross eta eta dx dy X Y)). pose proof (dot_norm b _ _ (within_cross eta eta dz dx Z X)).
  pose proof (dot_norm a _ _ (within_cross eta eta dy dz Y Z)). pose proof (det_of_cube eta eta eta dx dy dz X Y Z).
  pose proof (within_nonneg eta dx X).
  pose proof (Qmult_le_compat_r _ _ eta (cross_norm b c) ltac:(auto)).
  pose proof (Qmult_le_compat_r _ _ eta (cross_norm a c) ltac:(auto)).
  set (nab := norm1 (cofactors a b)) in *. set (na := norm1 a) in *. set (nb := norm1 b) in *. set (nc := norm1 c) in *.
  assert (eta * (nab + (na + nb + 2 * eta) * (nc + 2 * eta))
    == nab * eta + nb * nc * eta + na * nc * eta + nc * (2 * eta * eta) + nb * (2 * eta * eta) + na * (2 * eta * eta)
       + 4 * eta * eta * eta) as -> by ring.
  lra.
Qed.

(** cchip_sat_bound: E >= eta and F >= |c| + 2 E, both powers of two there *)
Definition sign_bound (E F : Q) (a b : point) : Q := E * (norm1 (cofactors a b) + (norm1 a + norm1 b + 2 * E) * F).
Definition gap_bound (E : Q) (L : point) : Q := E * norm1 L.

Lemma norm1_nonneg p : 0 <= norm1 p.
Proof.
  unfold norm1. pose proof (Qabs_nonneg (x p)). pose proof (Qabs_nonneg (y p)). pose proof (Qabs_nonneg (z p)). lra.
Qed.
Theorem sign_certain eta E F a b c dx dy dz : within eta dx -> within eta dy -> within eta dz ->
  eta <= E -> norm1 c + 2 * E <= F ->
  let t := det a b c in let true_t := det (plus a dx) (plus b dy) (plus c dz) in
  (sign_bound E F a b < t -> 0 < true_t) /\ (t < - sign_bound E F a b -> true_t < 0).
Proof.
  intros X Y Z HE HF. cbv zeta. pose proof (error_of_sign eta a b c dx dy dz X Y Z) as H.
  apply Qabs_Qle_condition in H. pose proof (within_nonneg eta dx X).
  assert (eta * (norm1 (cofactors a b) + (norm1 a + norm1 b + 2 * eta) * (norm1 c + 2 * eta)) <= sign_bound E F a b) as B.
  { unfold sign_bound. pose proof (norm1_nonneg (cofactors a b)). pose proof (norm1_nonneg a). pose proof (norm1_nonneg b).
    pose proof (norm1_nonneg c).
    set (nab := norm1 (cofactors a b)) in *. set (s := norm1 a + norm1 b + 2 * eta). set (s' := norm1 a + norm1 b + 2 * E).
    set (g := norm1 c + 2 * eta). assert (0 <= s) by (unfold s; lra). assert (s <= s') by (unfold s, s'; lra).
    assert (0 <= g) by (unfold g; lra). assert (g <= F) by (unfold g; lra).
    assert (s * g <= s' * F) by nra. set (u := nab + s * g). set (v := nab + s' * F). assert (u <= v) by (unfold u, v; lra).
    assert (0 <= u) by (unfold u; nra). nra. }
  split; intros; lra.
Qed.

(** A definite no: the difference w - v of two vertices has the error dz. *)
Theorem gap_certain eta E L c dz : within eta dz -> eta <= E ->
  (gap_bound E L < dotq L c -> 0 < dotq L (plus c dz)) /\ (dotq L c < - gap_bound E L -> dotq L (plus c dz) < 0).
Proof.
  intros Z HE. pose proof (dot_norm L dz eta Z). pose proof (norm1_nonneg L). unfold gap_bound.
  assert (dotq L (plus c dz) == dotq L c + dotq L dz) as -> by (unfold plus; coordinates).
  assert (norm1 L * eta <= E * norm1 L) by nra. split; intros; lra.
Qed.

(** Rounded to nearest, two vertices have the error 1 in their difference. *)
Theorem eta_of_rounding v v' w w' : within (1 # 2) (minus v' v) -> within (1 # 2) (minus w' w) ->
  exists d, within 1 d /\ forall L, dotq L (minus w' v') == dotq L (plus (minus w v) d).
Proof.
  intros V W. exists (minus (minus w' w) (minus v' v)). split.
  - unfold within, minus in *; cbn [x y z] in *. lra.
  - intros L. unfold plus. coordinates.
Qed.

(** * Widths *)

Definition two (k : Z) : Q := inject_Z (2 ^ k).
Lemma two_plus a b : (0 <= a)%Z -> (0 <= b)%Z -> two (a + b) == two a * two b.
Proof. intros A B. unfold two. rewrite <- inject_Z_mult, <- Z.pow_add_r by auto. reflexivity. Qed.
Lemma two_le a b : (0 <= a)%Z -> (a <= b)%Z -> two a <= two b.
Proof. intros A B. apply inject_le, Z.pow_le_mono_r; lia. Qed.

(** A coordinate of w bits *)
Definition on_grid (w : Z) (p : point) : Prop :=
  let h := two (w - 1) in (- h <= x p <= h - 1) /\ (- h <= y p <= h - 1) /\ (- h <= z p <= h - 1).

Section Widths.
Variable w : Z.
Hypothesis legal : (4 <= w)%Z.
Let h := two (w - 1).
Let M := 2 * h - 1.

Lemma h_least : 8 <= h.
Proof. change 8 with (two 3). apply two_le; lia. Qed.
Lemma edge_within p q : on_grid w p -> on_grid w q -> within M (minus p q).
Proof. unfold on_grid, within, M, minus; cbn [x y z]. fold h. intros P Q. lra. Qed.

Lemma powers : two (EDGE_W w - 1) == 2 * h /\ two (AXIS_W w - 1) == 8 * h * h /\ two (PROJ_W w - 1) == 32 * h * h * h /\
  two (PROJ_ABS_W w - 1) == 16 * h * h * h /\ two (NORM_W w) == 16 * h /\ two (AXIS_NORM_W w) == 32 * h * h /\
  two (BOUND_W w) == 8192 * h * h /\ two (w + 3) == 16 * h.
Proof.
  unfold EDGE_W, AXIS_W, PROJ_W, PROJ_ABS_W, NORM_W, AXIS_NORM_W, BOUND_W, h.
  remember (w - 1)%Z as u eqn:Eu. assert (0 <= u)%Z by lia. assert (w = u + 1)%Z as Ew by lia. rewrite Ew.
  assert (forall k v, (0 <= k)%Z -> v = (k + u)%Z -> two v == two k * two u) as T1.
  { intros k v K ->. now rewrite two_plus. }
  assert (forall k v, (0 <= k)%Z -> v = (k + u + u)%Z -> two v == two k * two u * two u) as T2.
  { intros k v K ->. rewrite two_plus, (T1 k (k + u)%Z); auto; [reflexivity | lia]. }
  assert (forall k v, (0 <= k)%Z -> v = (k + u + u + u)%Z -> two v == two k * two u * two u * two u) as T3.
  { intros k v K ->. rewrite two_plus, (T2 k (k + u + u)%Z); auto; [reflexivity | lia]. }
  split; [apply (T1 1%Z); lia |]. split; [apply (T2 3%Z); lia |]. split; [apply (T3 5%Z); lia |].
  split; [apply (T3 4%Z); lia |]. split; [apply (T1 4%Z); lia |]. split; [apply (T2 5%Z); lia |].
  split; [apply (T2 13%Z); lia | apply (T1 4%Z); lia].
Qed.

(** Signed values of n bits: less than 2^(n-1) in absolute value; unsigned: less than 2^n. The edges e, f and c are
    differences of points of the grid, p is such a point; E and F are those of cchip_sat_bound. *)
Theorem widths_suffice e0 e1 f0 f1 c0 c1 p (s n : Z) : Forall (on_grid w) [e0; e1; f0; f1; c0; c1; p] ->
  (0 <= s <= 4)%Z -> (0 <= n)%Z ->
  let e := minus e1 e0 in let f := minus f1 f0 in let c := minus c1 c0 in let L := cofactors e f in
  (forall k, (0 <= k)%Z -> norm1 c + 2 * two s <= two k -> (n <= k)%Z) ->
  (forall v, In v [x e; y e; z e] -> Qabs v < two (EDGE_W w - 1)) /\
  (forall v, In v [x L; y L; z L] -> Qabs v < two (AXIS_W w - 1)) /\
  Qabs (dotq L c) < two (PROJ_W w - 1) /\
  Qabs (dotq L p) < two (PROJ_ABS_W w - 1) /\
  norm1 e + norm1 f < two (NORM_W w) /\
  norm1 L < two (AXIS_NORM_W w) /\
  gap_bound (two s) L < two (BOUND_W w) /\
  sign_bound (two s) (two n) e f < two (BOUND_W w).
Proof.
  intros G S N0. cbv zeta. intros Least. rewrite Forall_forall in G.
  assert (forall q, In q [e0; e1; f0; f1; c0; c1; p] -> on_grid w q) as G' by auto.
  assert (within M (minus e1 e0)) as E by (apply edge_within; apply G; cbn; tauto).
  assert (within M (minus f1 f0)) as F by (apply edge_within; apply G; cbn; tauto).
  assert (within M (minus c1 c0)) as C by (apply edge_within; apply G; cbn; tauto).
  assert (within h p) as P.
  { assert (on_grid w p) as Gp by (apply G; cbn; tauto). unfold on_grid, within in *. fold h in Gp. lra. }
  set (e := minus e1 e0) in *. set (f := minus f1 f0) in *. set (c := minus c1 c0) in *. clear G G'.
  destruct powers as (W1 & W2 & W3 & W4 & W5 & W6 & W7 & W8). pose proof h_least as H.
  assert (M == 2 * h - 1) as HM by reflexivity.
  assert (M * M <= 4 * h * h - 2 * h) as MM by nra.
  pose proof (within_cross M M e f E F) as Ax. pose proof (cross_of_cube M M e f E F) as N4.
  assert (forall k v q, within k q -> In v [x q; y q; z q] -> Qabs v <= k) as Comp.
  { intros k v q (Qx & Qy & Qz) [<- | [<- | [<- | []]]]; now apply Qabs_Qle_condition. }
  pose proof (within_norm M e E) as Ne. pose proof (within_norm M f F) as Nf. pose proof (within_norm M c C) as Nc.
  assert (0 < two s /\ two s <= 16) as (S0 & S16).
  { split; [change 0 with (inject_Z 0); apply inject_lt, Z.pow_pos_nonneg; lia | change 16 with (two 4); apply two_le; lia]. }
  assert (two n <= 16 * h) as Fn.
  { rewrite <- W8. apply two_le; [auto | apply Least; [lia |]]. rewrite W8. lra. }
  assert (norm1 (cofactors e f) <= 16 * h * h - 8 * h) as NL by nra.
  pose proof (norm1_nonneg (cofactors e f)) as NL0. pose proof (norm1_nonneg e). pose proof (norm1_nonneg f).
  split; [intros v I; apply (Comp M) in I; auto; lra |].
  split; [intros v I; apply (Comp _ v _ Ax) in I; rewrite W2; nra |].
  split.
  { pose proof (det_of_cube M M M e f c E F C) as D. unfold det in D. apply Qabs_Qle_condition in D. rewrite W3. nra. }
  split.
  { pose proof (det_of_cube M M h e f p E F P) as D. unfold det in D. apply Qabs_Qle_condition in D. rewrite W4. nra. }
  split; [rewrite W5; lra |]. split; [rewrite W6; nra |].
  unfold gap_bound, sign_bound. set (l := norm1 (cofactors e f)) in *. set (ne := norm1 e + norm1 f) in *.
  assert (0 < two n) as Fn0 by (change 0 with (inject_Z 0); apply inject_lt, Z.pow_pos_nonneg; lia).
  assert (two s * l <= 16 * l) by nra.
  split; [rewrite W7; nra |].
  assert (0 <= ne) by (unfold ne; lra). assert (ne <= 12 * h) by (unfold ne; lra).
  assert ((ne + 2 * two s) * two n <= (12 * h + 32) * (16 * h)) by nra.
  assert (0 <= (ne + 2 * two s) * two n) by nra. set (g := (ne + 2 * two s) * two n) in *.
  assert (two s * (l + g) <= 16 * (l + g)) by nra. rewrite W7. nra.
Qed.
End Widths.
