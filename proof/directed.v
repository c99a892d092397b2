(* SPDX-License-Identifier: Apache-2.0 *)
(** The two schedules of the axis controller give the same answer for triangles (docs/develop/architecture.md,
    "Programmes" and "Two axes decide"): [directed_is_exhaustive] at the end. *)
Require Import ZArith QArith Lqa Lia List Bool.
From Certificates Require Import statement geometry gordan axes.
Import ListNotations.
Open Scope Q_scope.

(** * The programmes *)

Definition below (A B : list point) (w : point) : bool :=
  forallb (fun a => forallb (fun b => is_pos (dotq w b - dotq w a)) B) A.
Definition parts (A B : triangle) (w : point) : bool :=
  below (corners A) (corners B) w || below (corners B) (corners A) w.

(** One beat in flight, until the first separation; and all beats, of which the first separation is kept. *)
Fixpoint until_first (sep : point -> bool) (ws : list point) : option point :=
  match ws with [] => None | w :: ws => if sep w then Some w else until_first sep ws end.
Definition all_beats (sep : point -> bool) (ws : list point) : option point :=
  fold_left (fun found w => match found with Some _ => found | None => if sep w then Some w else None end) ws None.

Definition at_zero (p : point) : bool := Qeq_bool (x p) 0 && Qeq_bool (y p) 0 && Qeq_bool (z p) 0.
Definition first (t : triangle) : point := fst (fst t).
(** s(W_j): heights of B's vertices over A's plane *)
Definition heights (A B : triangle) : Q * Q * Q :=
  let h p := dotq (normal A) (minus p (first A)) in let '(p, q, r) := B in (h p, h q, h r).
Definition on_plane (A B : triangle) : bool :=
  let '(a, b, c) := heights A B in Qeq_bool a 0 && Qeq_bool b 0 && Qeq_bool c 0.

Inductive plan := Degenerate | Coplanar | Crossing.
Definition plan_of (A B : triangle) : plan :=
  if at_zero (normal A) || at_zero (normal B) then Degenerate else if on_plane A B then Coplanar else Crossing.

(** On the positive side; a zero counts as negative if there is no negative vertex, otherwise as positive. *)
Definition sides (h : Q * Q * Q) : bool * bool * bool :=
  let '(a, b, c) := h in
  let some_negative := is_pos (- a) || is_pos (- b) || is_pos (- c) in
  let side s := negb (is_pos (- s)) && (is_pos s || some_negative) in (side a, side b, side c).
(** First edge from side [from] to the other one; 0 if there is none *)
Definition crossing_edge (from : bool) (s : bool * bool * bool) : nat :=
  let '(a, b, c) := s in
  let leads s t := eqb s from && eqb t (negb from) in
  if leads a b then 0%nat else if leads b c then 1%nat else if leads c a then 2%nat else 0%nat.
Definition edge_number (t : triangle) (k : nat) : point := nth k (edges t) (Triple 0 0 0).
(** A+- x B+- and A-+ x B-+ *)
Definition crossing_axis (down : bool) (A B : triangle) : point :=
  cofactors (edge_number A (crossing_edge down (sides (heights B A))))
            (edge_number B (crossing_edge down (sides (heights A B)))).
Definition crossing_axes (A B : triangle) : list point := [crossing_axis true A B; crossing_axis false A B].

Section Schedules.
(** A component in which nA is not zero, if there is one: the hardware takes the largest. *)
Variable largest : point -> component.
Hypothesis largest_not_zero : forall n, ~ zero n -> ~ dotq n (unit (largest n)) == 0.

Definition directed (A B : triangle) : option point :=
  match until_first (parts A B) [normal A; normal B] with
  | Some w => Some w
  | None => until_first (parts A B)
      match plan_of A B with
      | Degenerate => cross_axes (edges A) (edges B) ++ degenerate_axes A B
      | Coplanar => in_plane_axes (largest (normal A)) A B
      | Crossing => crossing_axes A B
      end
  end.

Definition exhaustive (A B : triangle) : option point :=
  match all_beats (parts A B) (general_axes A B) with
  | Some w => Some w
  | None => until_first (parts A B)
      match plan_of A B with
      | Degenerate => cross_axes (edges A) (edges B) ++ degenerate_axes A B
      | Coplanar => in_plane_axes (largest (normal A)) A B
      | Crossing => []
      end
  end.

(** * Searches *)

Lemma below_spec A B w : below A B w = true <-> forall a b, In a A -> In b B -> dotq w a < dotq w b.
Proof.
  unfold below. rewrite forallb_forall. split.
  - intros H a b HA HB. apply H in HA. rewrite forallb_forall in HA. apply HA, is_pos_spec in HB. lra.
  - intros H a HA. apply forallb_forall. intros b HB. apply is_pos_spec. pose proof (H a b HA HB). lra.
Qed.
Lemma parts_spec A B w : parts A B w = true <-> separates (corners A) (corners B) w.
Proof.
  unfold parts, separates. rewrite orb_true_iff, !below_spec. split; intros [H | H]; auto.
Qed.

Lemma until_first_some sep ws : (exists w, until_first sep ws = Some w) <-> exists w, In w ws /\ sep w = true.
Proof.
  induction ws as [| v ws IH]; cbn.
  - split; intros (w & H); [discriminate | tauto].
  - destruct (sep v) eqn:E.
    + split; intros _; [exists v; auto | eauto].
    + rewrite IH. split; intros (w & I & S); [exists w; auto |]. destruct I as [-> | I]; [congruence | eauto].
Qed.
Lemma all_beats_is_until_first sep ws : all_beats sep ws = until_first sep ws.
Proof.
  unfold all_beats. assert (forall w us, fold_left (fun found v => match found with Some _ => found
    | None => if sep v then Some v else None end) us (Some w) = Some w) as Kept by (intros w; induction us; cbn; auto).
  induction ws as [| v ws IH]; cbn; [auto |]. destruct (sep v); auto.
Qed.
Lemma until_first_axes A B ws :
  (exists w, until_first (parts A B) ws = Some w) <-> some_axis A B ws.
Proof. rewrite until_first_some. unfold some_axis. split; intros (w & I & S); exists w; rewrite parts_spec in *; auto. Qed.

Lemma at_zero_spec p : at_zero p = true <-> zero p.
Proof. unfold at_zero, zero. rewrite !andb_true_iff, !Qeq_bool_iff. tauto. Qed.

(** * Heights *)

Lemma normal_level A a : In a (corners A) -> dotq (normal A) (minus a (first A)) == 0.
Proof. destruct A as ((p, q), r). intros [<- | [<- | [<- | []]]]; cbn [first normal fst snd]; coordinates. Qed.
Lemma height_of_pair A a b : In a (corners A) ->
  dotq (normal A) (minus b (first A)) == dotq (normal A) b - dotq (normal A) a.
Proof. intros I. apply normal_level in I. rewrite dotq_minus in *. lra. Qed.

Lemma on_plane_spec A B : on_plane A B = true <-> forall b, In b (corners B) -> dotq (normal A) (minus b (first A)) == 0.
Proof.
  unfold on_plane, heights. destruct B as ((p, q), r). rewrite !andb_true_iff, !Qeq_bool_iff. cbn [corners]. split.
  - intros ((P & Q) & R) b [<- | [<- | [<- | []]]]; auto.
  - intros H. repeat split; apply H; cbn; auto.
Qed.
Lemma on_plane_coplanar A B : on_plane A B = true <-> coplanar A B.
Proof.
  rewrite on_plane_spec. split.
  - intros H a b HA HB. apply H in HB. rewrite (height_of_pair A a b HA) in HB. rewrite dotq_minus. lra.
  - intros H b HB. assert (In (first A) (corners A)) as I by (destruct A as ((?, ?), ?); cbn; auto).
    pose proof (H _ b I HB). rewrite dotq_minus in *. lra.
Qed.

Lemma coplanar_swapped A B : ~ degenerate A B -> coplanar B A -> coplanar A B.
Proof.
  intros Deg Co a b HA HB.
  assert (~ zero (normal B)) as N by (intros Z; apply Deg; now right). apply positive_square in N.
  assert (forall a', In a' (corners A) -> dotq (normal B) (minus a' b) == 0) as E.
  { intros a' HA'. pose proof (Co b a' HB HA') as F. rewrite dotq_minus in *. lra. }
  assert (forall a' a'', In a' (corners A) -> In a'' (corners A) -> dotq (normal B) (minus a' a'') == 0) as F.
  { intros a' a'' I J. apply E in I, J. rewrite dotq_minus in *. lra. }
  assert (dotq (normal B) (normal B) * dotq (normal A) (minus a b)
    == dotq (normal B) (normal A) * dotq (normal B) (minus a b)) as G.
  { destruct A as ((p, q), r). apply parallel_product; apply F; cbn; auto. }
  rewrite E in G by auto. nra.
Qed.

Lemma normal_separates A B : (forall b, In b (corners B) -> 0 < dotq (normal A) (minus b (first A))) \/
  (forall b, In b (corners B) -> dotq (normal A) (minus b (first A)) < 0) -> separates (corners A) (corners B) (normal A).
Proof.
  intros [H | H]; [left | right]; intros a b HA HB; apply H in HB; rewrite (height_of_pair A a b HA) in HB; lra.
Qed.
Lemma separates_swapped A B w : separates A B w -> separates B A w.
Proof. intros [S | S]; [right | left]; auto. Qed.

(** * Two axes decide *)

(** The same triangle, from vertex k on *)
Definition turned (t : triangle) (k : nat) : triangle :=
  let '(p, q, r) := t in match k with O => (p, q, r) | 1%nat => (q, r, p) | _ => (r, p, q) end.
Lemma corners_turned t k v : In v (corners (turned t k)) <-> In v (corners t).
Proof. destruct t as ((p, q), r), k as [| [| k]]; cbn; tauto. Qed.
Lemma normal_turned t k v : dotq (normal (turned t k)) v == dotq (normal t) v.
Proof. destruct t as ((p, q), r), k as [| [| k]]; cbn [turned normal]; coordinates. Qed.

(** An edge from side to side: heights of its ends *)
Definition goes (down : bool) (a b : Q) : Prop := if down then b <= 0 <= a /\ b < a else a <= 0 <= b /\ a < b.
Lemma crossing_edge_spec down a b c : ~ (a == 0 /\ b == 0 /\ c == 0) -> ~ (0 < a /\ 0 < b /\ 0 < c) ->
  ~ (a < 0 /\ b < 0 /\ c < 0) ->
  match crossing_edge down (sides (a, b, c)) with O => goes down a b | 1%nat => goes down b c | _ => goes down c a end.
Proof.
  intros N P M. unfold sides, is_pos.
  destruct (Qlt_le_dec 0 (- a)), (Qlt_le_dec 0 (- b)), (Qlt_le_dec 0 (- c));
    destruct (Qlt_le_dec 0 a), (Qlt_le_dec 0 b), (Qlt_le_dec 0 c); destruct down; cbn; try lra;
    exfalso; lra || (apply N; lra) || (apply P; lra) || (apply M; lra).
Qed.

(** A point on the edge from p to m where the height is zero *)
Lemma zero_on_edge down N o p m : goes down (dotq N (minus p o)) (dotq N (minus m o)) ->
  exists l, 0 <= l /\ l <= 1 /\ dotq N (minus (blend (1 - l) l p m) o) == 0.
Proof.
  intros G. set (a := dotq N (minus p o)) in *. set (b := dotq N (minus m o)) in *.
  assert (forall l, dotq N (minus (blend (1 - l) l p m) o) == a + l * (b - a)) as E.
  { intros l. unfold a, b, blend; coordinates. }
  exists (a / (a - b)). rewrite E. destruct down; destruct G as ((G1 & G2) & G3).
  - split; [apply Qle_shift_div_l; lra |]. split; [apply Qle_shift_div_r; lra | field; lra].
  - assert (a / (a - b) == - a / (b - a)) as F by (field; lra). rewrite F.
    split; [apply Qle_shift_div_l; lra |]. split; [apply Qle_shift_div_r; lra | field; lra].
Qed.

Section Edges.
Variables (A B : triangle).
Let nA := normal A.
Let nB := normal B.
Variables (p m v q r u : point).                (* A = p m v, B = q r u, in cyclic order *)
Let e := minus m p.
Let f := minus r q.
Let t := dotq (cofactors e f) (minus q p).

Lemma crossing_separates down :
  goes down (dotq (normal (q, r, u)) (minus p q)) (dotq (normal (q, r, u)) (minus m q)) ->
  goes down (dotq (normal (p, m, v)) (minus q p)) (dotq (normal (p, m, v)) (minus r p)) ->
  (if down then t < 0 else 0 < t) -> separates [p; m; v] [q; r; u] (cofactors e f).
Proof.
  intros GA GB T.
  assert (dotq (cofactors e f) v - dotq (cofactors e f) p
    == dotq (normal (p, m, v)) (minus q p) - dotq (normal (p, m, v)) (minus r p)) as Va.
  { unfold e, f; cbn [normal]. coordinates. }
  assert (dotq (cofactors e f) u - dotq (cofactors e f) q
    == dotq (normal (q, r, u)) (minus m q) - dotq (normal (q, r, u)) (minus p q)) as Ub.
  { unfold e, f; cbn [normal]. coordinates. }
  assert (dotq (cofactors e f) m == dotq (cofactors e f) p) as Ma by (unfold e, f; coordinates).
  assert (dotq (cofactors e f) r == dotq (cofactors e f) q) as Rb by (unfold e, f; coordinates).
  assert (t == dotq (cofactors e f) q - dotq (cofactors e f) p) as Et by apply dotq_minus.
  clearbody t e f. clear nA nB. unfold goes in *.
  destruct down; [right | left]; intros a b [<- | [<- | [<- | []]]] [<- | [<- | [<- | []]]]; lra.
Qed.
End Edges.

Section Line.
Variables (vs us : list point) (nA nB oA oB : point).
Hypothesis level_a : forall a, In a vs -> dotq nA (minus a oA) == 0.
Hypothesis level_b : forall b, In b us -> dotq nB (minus b oB) == 0.
Let d := cofactors nA nB.
Definition on_line (p : point) : Prop := dotq nA (minus p oA) == 0 /\ dotq nB (minus p oB) == 0.

Lemma blend_level N o p m l : dotq N (minus p o) == 0 -> dotq N (minus m o) == 0 ->
  dotq N (minus (blend (1 - l) l p m) o) == 0.
Proof.
  intros P M. assert (dotq N (minus (blend (1 - l) l p m) o)
    == (1 - l) * dotq N (minus p o) + l * dotq N (minus m o)) as -> by (unfold blend; coordinates).
  rewrite P, M. ring.
Qed.

Lemma along_line p q w : on_line p -> on_line q -> dotq d d * dotq (minus q p) w == dotq d (minus q p) * dotq d w.
Proof.
  intros (Pa & Pb) (Qa & Qb). rewrite (dotq_comm d (minus q p)). rewrite dotq_minus in Pa, Pb, Qa, Qb.
  apply parallel; [rewrite (dotq_comm _ nA) | rewrite (dotq_comm _ nB)]; rewrite dotq_minus; lra.
Qed.

(** Where two edges cross the line, in which order: by the sign of t *)
Lemma crossing_order down p m q r : In p vs -> In m vs -> In q us -> In r us ->
  goes down (dotq nB (minus p oB)) (dotq nB (minus m oB)) -> goes down (dotq nA (minus q oA)) (dotq nA (minus r oA)) ->
  0 < dotq d d /\ exists P R, hull vs P /\ hull us R /\ on_line P /\ on_line R /\
    let t := dotq (cofactors (minus m p) (minus r q)) (minus q p) in
    (0 <= t -> dotq d R <= dotq d P) /\ (t <= 0 -> dotq d P <= dotq d R).
Proof.
  intros HP HM HQ HR GA GB.
  destruct (zero_on_edge down nB oB p m GA) as (l & L0 & L1 & LB).
  destruct (zero_on_edge down nA oA q r GB) as (k & K0 & K1 & KA).
  set (P := blend (1 - l) l p m) in *. set (R := blend (1 - k) k q r) in *.
  assert (on_line P) as OP by (split; [now apply blend_level; apply level_a | auto]).
  assert (on_line R) as OR by (split; [auto | now apply blend_level; apply level_b]).
  set (e := minus m p). set (f := minus r q).
  assert (dotq nA e == 0) as Ae.
  { pose proof (level_a p HP). pose proof (level_a m HM) as M. unfold e. rewrite dotq_minus in *. lra. }
  assert (dotq nB f == 0) as Bf.
  { pose proof (level_b q HQ). pose proof (level_b r HR). unfold f. rewrite dotq_minus in *. lra. }
  assert (0 < dotq nB e * dotq nA f) as Pos.
  { unfold e, f. rewrite !dotq_minus. unfold goes in GA, GB.
    pose proof (dotq_minus nB p oB) as Ep. pose proof (dotq_minus nB m oB) as Em.
    pose proof (dotq_minus nA q oA) as Eq. pose proof (dotq_minus nA r oA) as Er.
    set (a := dotq nB m - dotq nB p). set (b := dotq nA r - dotq nA q).
    destruct down; destruct GA as (_ & GA), GB as (_ & GB).
    - assert (a < 0) by (unfold a; lra). assert (b < 0) by (unfold b; lra). nra.
    - assert (0 < a) by (unfold a; lra). assert (0 < b) by (unfold b; lra). nra. }
  assert (dotq d (cofactors e f) == - (dotq nB e * dotq nA f)) as De.
  { assert (dotq d (cofactors e f) == dotq nA e * dotq nB f - dotq nB e * dotq nA f) as -> by (unfold d; coordinates).
    rewrite Ae. ring. }
  assert (0 < dotq d d) as Dd.
  { apply positive_square. intros (Ex & Ey & Ez). unfold dotq at 1 in De. rewrite Ex, Ey, Ez in De. lra. }
  split; [auto |]. exists P, R. split; [apply hull_convex; try apply hull_vertex; auto; lra |].
  split; [apply hull_convex; try apply hull_vertex; auto; lra |]. split; [auto |]. split; [auto |].
  assert (dotq (cofactors e f) (minus q p) == dotq (minus R P) (cofactors e f)) as Et.
  { unfold R, P, e, f, blend. coordinates. }
  pose proof (along_line P R (cofactors e f) OP OR) as E. rewrite De, <- Et, (dotq_minus d R P) in E.
  cbv zeta. set (t := dotq (cofactors e f) (minus q p)) in *.
  split; intros T; set (g := dotq nB e * dotq nA f) in *; set (dd := dotq d d) in *;
    set (a := dotq d R) in *; set (b := dotq d P) in *.
  - destruct (Qlt_le_dec b a); [| auto]. assert (0 < (a - b) * g) by nra. assert (0 <= dd * t) by nra. lra.
  - destruct (Qlt_le_dec a b); [| auto]. assert (0 < (b - a) * g) by nra. assert (dd * t <= 0) by nra. lra.
Qed.

Lemma in_between ws P Q R : 0 < dotq d d -> on_line P -> on_line Q -> on_line R -> hull ws P -> hull ws Q ->
  dotq d P <= dotq d R -> dotq d R <= dotq d Q ->
  exists S, hull ws S /\ x R == x S /\ y R == y S /\ z R == z S.
Proof.
  intros Dd OP OQ OR HP HQ LP LQ.
  assert (exists l, 0 <= l /\ l <= 1 /\ dotq d R - dotq d P == l * (dotq d Q - dotq d P)) as (l & L0 & L1 & E).
  { destruct (Qlt_le_dec (dotq d P) (dotq d Q)).
    - exists ((dotq d R - dotq d P) / (dotq d Q - dotq d P)).
      split; [apply Qle_shift_div_l; lra |]. split; [apply Qle_shift_div_r; lra | field; lra].
    - exists 0. split; [lra |]. split; [lra |]. lra. }
  exists (blend (1 - l) l P Q). split; [apply hull_convex; auto; lra |].
  assert (zero (minus (minus R P) (minus (blend (1 - l) l P Q) P))) as Z.
  { apply zero_products. intros w. pose proof (along_line P R w OP OR) as ER. pose proof (along_line P Q w OP OQ) as EQ.
    rewrite (dotq_minus d R P) in ER. rewrite (dotq_minus d Q P) in EQ. rewrite E in ER.
    assert (dotq (minus (minus R P) (minus (blend (1 - l) l P Q) P)) w
      == dotq (minus R P) w - l * dotq (minus Q P) w) as -> by (unfold blend; coordinates).
    set (a := dotq (minus R P) w) in *. set (b := dotq (minus Q P) w) in *. set (dd := dotq d d) in *.
    set (g := dotq d Q - dotq d P) in *. set (h := dotq d w) in *.
    assert (dd * (a - l * b) == 0) by (setoid_replace (dd * (a - l * b)) with (dd * a - l * (dd * b)) by ring;
      rewrite ER, EQ; ring).
    nra. }
  destruct Z as (Zx & Zy & Zz). unfold minus in *; cbn in *. repeat split; lra.
Qed.

Lemma crossing_meets p1 m1 q1 r1 p2 m2 q2 r2 :
  In p1 vs -> In m1 vs -> In q1 us -> In r1 us -> In p2 vs -> In m2 vs -> In q2 us -> In r2 us ->
  goes true (dotq nB (minus p1 oB)) (dotq nB (minus m1 oB)) -> goes true (dotq nA (minus q1 oA)) (dotq nA (minus r1 oA)) ->
  goes false (dotq nB (minus p2 oB)) (dotq nB (minus m2 oB)) -> goes false (dotq nA (minus q2 oA)) (dotq nA (minus r2 oA)) ->
  0 <= dotq (cofactors (minus m1 p1) (minus r1 q1)) (minus q1 p1) ->
  dotq (cofactors (minus m2 p2) (minus r2 q2)) (minus q2 p2) <= 0 -> meet vs us.
Proof.
  intros P1 M1 Q1 R1 P2 M2 Q2 R2 GA GB GA' GB' T1 T2.
  destruct (crossing_order true p1 m1 q1 r1) as (Dd & S1 & V1 & H1 & K1 & O1 & L1 & F1 & _); auto.
  destruct (crossing_order false p2 m2 q2 r2) as (_ & S2 & V2 & H2 & K2 & O2 & L2 & _ & F2); auto.
  cbv zeta in F1, F2. apply F1 in T1. apply F2 in T2. clear F1 F2.
  destruct (Qlt_le_dec (dotq d V2) (dotq d S1)) as [Less | Le].
  - destruct (in_between vs S2 S1 V2) as (S & HS & X & Y & Z); auto; [lra |].
    exists S, V2. cbn. repeat split; auto; lra.
  - destruct (in_between us V1 V2 S1) as (S & HS & X & Y & Z); auto.
    exists S1, S. cbn. repeat split; auto; lra.
Qed.
End Line.

(** * The schedules decide *)

Lemma turned_edge T k : exists p m v, turned T k = (p, m, v) /\ In p (corners T) /\ In m (corners T) /\
  ((k < 3)%nat -> edge_number T k = minus m p).
Proof.
  destruct T as ((p, q), r). destruct k as [| [| [| k]]]; cbn [turned]; do 3 eexists; (split; [reflexivity |]);
    (split; [cbn; auto |]); (split; [cbn; auto |]); intros; try reflexivity; lia.
Qed.
Lemma crossing_edge_less down s : (crossing_edge down s < 3)%nat.
Proof.
  destruct s as ((a, b), c). unfold crossing_edge.
  repeat match goal with |- context [if ?c then _ else _] => destruct c end; lia.
Qed.

(** Heights over A's plane have both signs, or zeros, if nA does not separate and B is not in that plane. *)
Lemma crossing_edge_goes down A B p m v : ~ separates (corners A) (corners B) (normal A) ->
  ~ (forall b, In b (corners B) -> dotq (normal A) (minus b (first A)) == 0) ->
  turned B (crossing_edge down (sides (heights A B))) = (p, m, v) ->
  goes down (dotq (normal A) (minus p (first A))) (dotq (normal A) (minus m (first A))).
Proof.
  intros S N E. destruct B as ((b0, b1), b2). cbn [heights] in E. cbn [corners] in *.
  pose proof (crossing_edge_less down (sides (heights A (b0, b1, b2)))) as Less. cbn [heights] in Less.
  pose proof (crossing_edge_spec down (dotq (normal A) (minus b0 (first A))) (dotq (normal A) (minus b1 (first A)))
    (dotq (normal A) (minus b2 (first A)))) as C.
  unfold heights in E, Less.
  destruct (crossing_edge down _) as [| [| [| k]]]; [| | | lia]; cbn [turned] in E; injection E as <- <- <-.
  all: apply C; intros (E0 & E1 & E2);
    [apply N | apply S, (normal_separates A (b0, b1, b2)); left | apply S, (normal_separates A (b0, b1, b2)); right];
    intros b [<- | [<- | [<- | []]]]; auto.
Qed.

Lemma goes_turned down A k p q o : goes down (dotq (normal A) (minus p o)) (dotq (normal A) (minus q o)) ->
  forall o', dotq (normal A) (minus o' o) == 0 ->
  goes down (dotq (normal (turned A k)) (minus p o')) (dotq (normal (turned A k)) (minus q o')).
Proof.
  intros G o' O. unfold goes in *.
  assert (forall v, dotq (normal (turned A k)) (minus v o') == dotq (normal A) (minus v o)) as E.
  { intros v. rewrite normal_turned, !dotq_minus. rewrite dotq_minus in O. lra. }
  pose proof (E p). pose proof (E q). destruct down; lra.
Qed.

Theorem two_axes_decide A B : ~ meet (corners A) (corners B) -> ~ degenerate A B -> ~ coplanar A B ->
  ~ separates (corners A) (corners B) (normal A) -> ~ separates (corners A) (corners B) (normal B) ->
  some_axis A B (crossing_axes A B).
Proof.
  intros H Deg Co SA SB.
  assert (~ separates (corners B) (corners A) (normal B)) as SB' by (intros S; now apply SB, separates_swapped).
  assert (~ (forall b, In b (corners B) -> dotq (normal A) (minus b (first A)) == 0)) as NB.
  { intros E. apply Co, on_plane_coplanar, on_plane_spec, E. }
  assert (~ (forall a, In a (corners A) -> dotq (normal B) (minus a (first B)) == 0)) as NA.
  { intros E. apply Co. apply coplanar_swapped; auto. now apply on_plane_coplanar, on_plane_spec. }
  set (k down := crossing_edge down (sides (heights B A))).
  set (l down := crossing_edge down (sides (heights A B))).
  assert (forall down, exists p m q r, In p (corners A) /\ In m (corners A) /\ In q (corners B) /\ In r (corners B) /\
    goes down (dotq (normal B) (minus p (first B))) (dotq (normal B) (minus m (first B))) /\
    goes down (dotq (normal A) (minus q (first A))) (dotq (normal A) (minus r (first A))) /\
    let t := dotq (cofactors (minus m p) (minus r q)) (minus q p) in
    ((if down then t < 0 else 0 < t) -> separates (corners A) (corners B) (crossing_axis down A B))) as Each.
  { intros down.
    destruct (turned_edge A (k down)) as (p & m & v & EA & HP & HM & KA).
    destruct (turned_edge B (l down)) as (q & r & u & EB & HQ & HR & KB).
    assert (goes down (dotq (normal B) (minus p (first B))) (dotq (normal B) (minus m (first B)))) as GA.
    { now apply (crossing_edge_goes down B A p m v). }
    assert (goes down (dotq (normal A) (minus q (first A))) (dotq (normal A) (minus r (first A)))) as GB.
    { now apply (crossing_edge_goes down A B q r u). }
    exists p, m, q, r. do 6 (split; [auto |]). cbv zeta. intros T.
    unfold crossing_axis. fold (k down) (l down). rewrite KA, KB by apply crossing_edge_less.
    assert (separates (corners (turned A (k down))) (corners (turned B (l down))) (cofactors (minus m p) (minus r q))) as S.
    { rewrite EA, EB. cbn [corners]. apply (crossing_separates p m v q r u down); auto.
      - rewrite <- EB. apply goes_turned with (first B); auto. now apply normal_level.
      - rewrite <- EA. apply goes_turned with (first A); auto. now apply normal_level. }
    destruct S as [S | S]; [left | right]; intros a b Ia Ib; apply S; now apply corners_turned. }
  destruct (Each true) as (p1 & m1 & q1 & r1 & P1 & M1 & Q1 & R1 & GA & GB & T1).
  destruct (Each false) as (p2 & m2 & q2 & r2 & P2 & M2 & Q2 & R2 & GA' & GB' & T2). cbv zeta in T1, T2.
  destruct (Qlt_le_dec (dotq (cofactors (minus m1 p1) (minus r1 q1)) (minus q1 p1)) 0) as [N1 | N1].
  { exists (crossing_axis true A B). split; [cbn; auto | auto]. }
  destruct (Qlt_le_dec 0 (dotq (cofactors (minus m2 p2) (minus r2 q2)) (minus q2 p2))) as [N2 | N2].
  { exists (crossing_axis false A B). split; [cbn; auto | auto]. }
  exfalso. apply H.
  apply (crossing_meets _ _ (normal A) (normal B) (first A) (first B) (normal_level A) (normal_level B)
    p1 m1 q1 r1 p2 m2 q2 r2); auto.
Qed.

Lemma none_axis A B ws : until_first (parts A B) ws = None -> ~ some_axis A B ws.
Proof. intros E S. apply until_first_axes in S. destruct S as (w & S). congruence. Qed.

Lemma plan_of_spec A B : match plan_of A B with
  | Degenerate => degenerate A B | Coplanar => ~ degenerate A B /\ coplanar A B
  | Crossing => ~ degenerate A B /\ ~ coplanar A B end.
Proof.
  unfold plan_of, degenerate. pose proof (at_zero_spec (normal A)) as ZA. pose proof (at_zero_spec (normal B)) as ZB.
  pose proof (on_plane_coplanar A B) as C.
  destruct (at_zero (normal A)), (at_zero (normal B)), (on_plane A B); cbn; intuition discriminate.
Qed.

(** In a common plane the products of edges are parallel to the normal, or zero. *)
Lemma coplanar_product A B w : ~ zero (normal A) -> coplanar A B -> In w (cross_axes (edges A) (edges B)) ->
  ~ separates (corners A) (corners B) w.
Proof.
  intros N Co I S. apply positive_square in N. apply in_cross_axes in I. destruct I as (e & f & HE & HF & <-).
  assert (exists a b, In a (corners A) /\ In b (corners B)) as (a & b & HA & HB).
  { destruct A as ((a, ?), ?), B as ((b, ?), ?). exists a, b. cbn. auto. }
  assert (dotq (normal A) e == 0) as E.
  { destruct A as ((p, q), r). destruct HE as [<- | [<- | [<- | []]]]; cbn [normal]; coordinates. }
  assert (dotq (normal A) f == 0) as F.
  { assert (forall b, In b (corners B) -> dotq (normal A) b == dotq (normal A) a) as L.
    { intros b' HB'. pose proof (Co a b' HA HB') as C. rewrite dotq_minus in C. lra. }
    destruct B as ((p, q), r).
    assert (In p [p; q; r] /\ In q [p; q; r] /\ In r [p; q; r]) as (P & Q & R) by (cbn; tauto).
    apply L in P, Q, R. destruct HF as [<- | [<- | [<- | []]]]; rewrite dotq_minus; lra. }
  pose proof (parallel_product (normal A) e f (minus a b) E F) as G. rewrite (Co a b HA HB), dotq_minus in G.
  set (n := dotq (normal A) (normal A)) in *. set (u := dotq (cofactors e f) a) in *. set (v := dotq (cofactors e f) b) in *.
  assert (u == v) by nra.
  destruct S as [S | S]; pose proof (S a b HA HB) as L; fold u v in L; lra.
Qed.

Theorem directed_decides A B : (exists w, directed A B = Some w) <-> ~ meet (corners A) (corners B).
Proof.
  unfold directed. destruct (until_first (parts A B) [normal A; normal B]) as [w |] eqn:E.
  - split; [intros _ | eauto].
    assert (some_axis A B [normal A; normal B]) as (v & _ & S) by (apply until_first_axes; eauto).
    now apply (separates_apart _ _ v).
  - rewrite until_first_axes. split; [intros (v & _ & S); now apply (separates_apart _ _ v) |].
    intros H. apply none_axis in E. pose proof (plan_of_spec A B) as P.
    assert (forall ws, some_axis A B ([normal A; normal B] ++ ws) -> some_axis A B ws) as Rest.
    { intros ws (v & I & S). apply in_app_or in I. destruct I as [I | I]; [exfalso; apply E |]; exists v; auto. }
    assert (~ separates (corners A) (corners B) (normal A)) by (intros S; apply E; exists (normal A); cbn; auto).
    assert (~ separates (corners A) (corners B) (normal B)) by (intros S; apply E; exists (normal B); cbn; auto).
    destruct (plan_of A B).
    + apply axes_complete in H. destruct H as [S | [(_ & v & I & S) | (N & _)]]; [| | tauto].
      * apply Rest in S. destruct S as (v & I & S). exists v. split; [apply in_or_app; auto | auto].
      * exists v. split; [apply in_or_app; auto | auto].
    + apply axes_complete in H. destruct H as [S | [(D & _) | (D & _ & S)]]; [| tauto |].
      * exfalso. apply Rest in S. destruct S as (v & I & S). apply (coplanar_product A B v); [| tauto | auto | auto].
        intros Z. apply P. now left.
      * apply S, largest_not_zero. intros Z. apply D. now left.
    + apply two_axes_decide; tauto.
Qed.

Theorem exhaustive_decides A B : (exists w, exhaustive A B = Some w) <-> ~ meet (corners A) (corners B).
Proof.
  unfold exhaustive. rewrite all_beats_is_until_first. destruct (until_first (parts A B) (general_axes A B)) as [w |] eqn:E.
  - split; [intros _ | eauto].
    assert (some_axis A B (general_axes A B)) as (v & _ & S) by (apply until_first_axes; eauto).
    now apply (separates_apart _ _ v).
  - rewrite until_first_axes. split; [intros (v & _ & S); now apply (separates_apart _ _ v) |].
    intros H. apply none_axis in E. pose proof (plan_of_spec A B) as P.
    apply axes_complete in H. destruct H as [S | H]; [tauto |].
    destruct (plan_of A B); destruct H as [(D & v & I & S) | (D & Co & S)]; try tauto.
    + exists v. split; [apply in_or_app; auto | auto].
    + apply S, largest_not_zero. intros Z. apply D. now left.
Qed.

(** Both answer alike; the axes that they name may differ. *)
Theorem directed_is_exhaustive A B : directed A B = None <-> exhaustive A B = None.
Proof.
  pose proof (directed_decides A B) as D. pose proof (exhaustive_decides A B) as E.
  destruct (directed A B), (exhaustive A B); split; intros N; try discriminate; auto; exfalso.
  - assert (exists w, @None point = Some w) as (w & F) by (apply E, D; eauto). discriminate.
  - assert (exists w, @None point = Some w) as (w & F) by (apply D, E; eauto). discriminate.
Qed.
End Schedules.
