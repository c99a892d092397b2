(* SPDX-License-Identifier: Apache-2.0 *)
(** Which axes decide two triangles (docs/develop/architecture.md, "Programmes"): [axes_decide] at the end. *)
Require Import ZArith QArith Lqa Lia List Bool.
From Certificates Require Import statement geometry gordan.
Import ListNotations.
Open Scope Q_scope.

(** * Axes *)

(** The intervals of A and of B on L are disjoint. *)
Definition separates (A B : list point) (L : point) : Prop :=
  (forall a b, In a A -> In b B -> dotq L a < dotq L b) \/ (forall a b, In a A -> In b B -> dotq L b < dotq L a).
Definition zero (p : point) : Prop := x p == 0 /\ y p == 0 /\ z p == 0.

Inductive component := Ux | Uy | Uz.
Definition unit (k : component) : point :=
  match k with Ux => Triple 1 0 0 | Uy => Triple 0 1 0 | Uz => Triple 0 0 1 end.
Definition all_units : list point := [unit Ux; unit Uy; unit Uz].

Definition cross_axes (es fs : list point) : list point := flat_map (fun e => map (cofactors e) fs) es.

Definition triangle := (point * point * point)%type.
Definition corners (t : triangle) : list point := let '(p, q, r) := t in [p; q; r].
Definition edges (t : triangle) : list point := let '(p, q, r) := t in [minus q p; minus r q; minus p r].
Definition normal (t : triangle) : point := let '(p, q, r) := t in cofactors (minus q p) (minus r p).

(** nA, nB and the nine products of edges. *)
Definition general_axes (A B : triangle) : list point :=
  [normal A; normal B] ++ cross_axes (edges A) (edges B).
(** Six axes in a common plane: products of the edges with a unit vector. *)
Definition in_plane_axes (d : component) (A B : triangle) : list point :=
  cross_axes (edges A) [unit d] ++ cross_axes (edges B) [unit d].
(** Axes of degenerate triangles, the boxes (unit vectors) among them. *)
Definition degenerate_axes (A B : triangle) : list point :=
  cross_axes (edges A) all_units ++ cross_axes (edges B) all_units ++ all_units.

(** * Identities *)

Lemma positive_square p : ~ zero p -> 0 < dotq p p.
Proof.
  intros H. destruct (Qlt_le_dec 0 (dotq p p)) as [| C]; auto. exfalso. apply H. unfold zero, dotq in *.
  assert (forall a, a * a <= 0 -> a == 0) as S by (intros a G; nra).
  repeat split; apply S; nra.
Qed.
Lemma zero_dec p : {zero p} + {~ zero p}.
Proof.
  unfold zero. destruct (Qeq_dec (x p) 0); [| right; tauto]. destruct (Qeq_dec (y p) 0); [| right; tauto].
  destruct (Qeq_dec (z p) 0); [left | right]; tauto.
Qed.
Lemma component_not_zero p : ~ zero p -> exists k, ~ dotq (unit k) p == 0.
Proof.
  intros H. destruct (Qeq_dec (x p) 0) as [Ex |]; [| exists Ux; unfold dotq; cbn; lra].
  destruct (Qeq_dec (y p) 0) as [Ey |]; [| exists Uy; unfold dotq; cbn; lra].
  exists Uz. unfold dotq; cbn. intros E. apply H. unfold zero. repeat split; lra.
Qed.

Ltac coordinates := unfold dotq, cofactors, minus; cbn [x y z]; try ring.
Lemma lagrange a b c : dotq a a * dotq b c == dotq a b * dotq a c + dotq (cofactors b a) (cofactors c a).
Proof. coordinates. Qed.
Lemma zero_products v : (forall p, dotq v p == 0) -> zero v.
Proof.
  intros H. pose proof (H (unit Ux)) as Hx. pose proof (H (unit Uy)) as Hy. pose proof (H (unit Uz)) as Hz.
  unfold dotq in *; cbn in *. repeat split; lra.
Qed.
Lemma double_product L u v q : dotq (cofactors L (cofactors u v)) q == dotq L v * dotq u q - dotq L u * dotq v q.
Proof. coordinates. Qed.
Lemma triple_product u v w : dotq (cofactors u v) w == dotq u (cofactors v w).
Proof. coordinates. Qed.
Lemma dotq_comm p q : dotq p q == dotq q p.
Proof. coordinates. Qed.
Lemma dotq_minus L a b : dotq L (minus a b) == dotq L a - dotq L b.
Proof. coordinates. Qed.

(** An axis at right angles to u and v is parallel to their product. *)
Lemma parallel L u v p : dotq L u == 0 -> dotq L v == 0 ->
  dotq (cofactors u v) (cofactors u v) * dotq L p == dotq L (cofactors u v) * dotq (cofactors u v) p.
Proof.
  intros U V. rewrite lagrange, double_product, U, V, (dotq_comm (cofactors u v) L). ring.
Qed.
Lemma parallel_product N u v p : dotq N u == 0 -> dotq N v == 0 ->
  dotq N N * dotq (cofactors u v) p == dotq N (cofactors u v) * dotq N p.
Proof.
  intros U V. rewrite lagrange.
  assert (dotq (cofactors (cofactors u v) N) (cofactors p N)
    == dotq N u * dotq v (cofactors p N) - dotq N v * dotq u (cofactors p N)) as -> by coordinates.
  rewrite U, V. ring.
Qed.

(** * From any axis that separates to a listed one *)

Section Axis.
Variables (A B : list point).
Let D := differences A B.

Lemma separates_by L w al be : ~ al == 0 -> (forall d, In d D -> 1 <= dotq L d) ->
  (forall d, In d D -> al * dotq L d == be * dotq w d) -> separates A B w.
Proof.
  intros N H E.
  assert (forall a b, In a A -> In b B -> 0 < al * (be * (dotq w a - dotq w b))) as S.
  { intros a b HA HB. assert (In (minus a b) D) as I by (apply in_differences; eauto).
    rewrite <- dotq_minus, <- (E _ I). apply H in I. set (l := dotq L (minus a b)) in *.
    assert (0 < al * al) by (destruct (Q_dec al 0) as [[|]|]; [nra | nra | tauto]). nra. }
  destruct (Qlt_le_dec 0 (al * be)) as [P | P].
  - right. intros a b HA HB. pose proof (S a b HA HB). nra.
  - left. intros a b HA HB. pose proof (S a b HA HB). nra.
Qed.

(** Moving L by v until one more difference has the product 1 *)
Definition slid (L v : point) (t : Q) : point := moved L t v.
Lemma dotq_slid L v t d : dotq (slid L v t) d == dotq L d + t * dotq v d.
Proof. unfold slid, moved, dotq; cbn. ring. Qed.

Lemma slide E L v : (forall d, In d E -> 1 <= dotq L d) -> (exists d, In d E /\ dotq v d < 0) ->
  exists t, 0 <= t /\ (forall d, In d E -> 1 <= dotq (slid L v t) d) /\
    exists d, In d E /\ dotq v d < 0 /\ dotq (slid L v t) d == 1.
Proof.
  induction E as [| e E IH]; intros H (d & I & V); [destruct I |].
  assert (forall t, 0 <= t -> t * - dotq v e <= dotq L e - 1 -> 1 <= dotq (slid L v t) e) as Keep.
  { intros t _ T. rewrite dotq_slid. lra. }
  assert (1 <= dotq L e) as He by (apply H; cbn; auto).
  assert (dotq v e < 0 -> let t := (dotq L e - 1) / - dotq v e in 0 <= t /\ t * dotq v e == 1 - dotq L e) as Own.
  { intros Ve. cbn zeta. split; [apply Qle_shift_div_l; lra | field; lra]. }
  destruct (existsb (fun d => is_pos (- dotq v d)) E) eqn:Some.
  - apply existsb_exists in Some. destruct Some as (f & F & Vf). apply is_pos_spec in Vf.
    destruct IH as (t & T & K & g & G & Vg & Eg); [intros; apply H; cbn; auto | exists f; split; [auto | lra] |].
    destruct (Qlt_le_dec (dotq (slid L v t) e) 1) as [Short | Fine].
    + rewrite dotq_slid in Short. assert (dotq v e < 0) as Ve by nra.
      destruct (Own Ve) as (S & Es). set (s := (dotq L e - 1) / - dotq v e) in *.
      exists s. split; [auto |]. assert (s < t) by nra. split.
      * intros c [<- | C]; [rewrite dotq_slid; lra |]. apply K in C as C1. assert (1 <= dotq L c) by (apply H; cbn; auto).
        rewrite dotq_slid in *. destruct (Qlt_le_dec (dotq v c) 0); nra.
      * exists e. split; [cbn; auto |]. split; [auto |]. rewrite dotq_slid. lra.
    + exists t. split; [auto |]. split; [intros c [<- | C]; auto |]. exists g. cbn. auto.
  - assert (forall c, In c E -> 0 <= dotq v c) as Up.
    { intros c C. destruct (Qlt_le_dec (dotq v c) 0) as [Neg |]; auto. exfalso.
      assert (existsb (fun d => is_pos (- dotq v d)) E = true); [| congruence].
      apply existsb_exists. exists c. split; auto. apply is_pos_spec. lra. }
    destruct I as [<- | I]; [| apply Up in I; lra].
    destruct (Own V) as (S & Es). set (s := (dotq L e - 1) / - dotq v e) in *.
    exists s. split; [auto |]. split.
    + intros c [<- | C]; [rewrite dotq_slid; lra |]. apply Up in C as C1. assert (1 <= dotq L c) by (apply H; cbn; auto).
      rewrite dotq_slid. nra.
    + exists e. split; [cbn; auto |]. split; [auto |]. rewrite dotq_slid. lra.
Qed.

Definition opposite (v : point) : point := Triple (- x v) (- y v) (- z v).
Lemma dotq_opposite v d : dotq (opposite v) d == - dotq v d.
Proof. unfold opposite, dotq; cbn. ring. Qed.

(** The products with which L does not change where v has none *)
Lemma slide_either L v : (forall d, In d D -> 1 <= dotq L d) -> (exists d, In d D /\ ~ dotq v d == 0) ->
  exists M, (forall d, In d D -> 1 <= dotq M d) /\ (forall d, dotq v d == 0 -> dotq M d == dotq L d) /\
    exists d, In d D /\ ~ dotq v d == 0 /\ dotq M d == 1.
Proof.
  intros H (d & I & V).
  assert (exists u, dotq u d < 0 /\ forall c, dotq u c == dotq v c \/ dotq u c == - dotq v c) as (u & U & R).
  { destruct (Qlt_le_dec (dotq v d) 0).
    - exists v. split; [auto | left; reflexivity].
    - exists (opposite v). split; [rewrite dotq_opposite; lra | right; apply dotq_opposite]. }
  destruct (slide D L u H) as (t & _ & K & g & G & Vg & Eg); [eauto |].
  exists (slid L u t). split; [auto |]. split.
  - intros c C. rewrite dotq_slid. destruct (R c) as [-> | ->]; rewrite C; ring.
  - exists g. split; [auto |]. split; [destruct (R g); lra | auto].
Qed.

(** What holds L in its place: three differences; two, and all others lie in their plane; or one line. *)
Inductive held (L : point) : Prop :=
| held_by_three d1 d2 d3 : In d1 D -> In d2 D -> In d3 D -> dotq L d1 == 1 -> dotq L d2 == 1 -> dotq L d3 == 1 ->
    ~ dotq (cofactors d1 d2) d3 == 0 -> held L
| held_in_plane d1 d2 : In d1 D -> In d2 D -> dotq L d1 == 1 -> dotq L d2 == 1 -> ~ zero (cofactors d1 d2) ->
    (forall d, In d D -> dotq (cofactors d1 d2) d == 0) -> held L
| held_on_line d1 : In d1 D -> dotq L d1 == 1 -> (forall d, In d D -> zero (cofactors d1 d)) -> held L.

Lemma search {P : point -> Prop} (E : list point) : (forall d, {P d} + {~ P d}) ->
  (exists d, In d E /\ ~ P d) \/ (forall d, In d E -> P d).
Proof.
  intros dec. induction E as [| e E [(d & I & N) | IH]]; [right; cbn; tauto | left; exists d; cbn; auto |].
  destruct (dec e); [right; intros d [<- | I]; auto | left; exists e; cbn; auto].
Qed.

Lemma hold L0 : D <> [] -> (forall d, In d D -> 0 < dotq L0 d) ->
  exists L, (forall d, In d D -> 1 <= dotq L d) /\ held L.
Proof.
  intros Ne H0.
  assert (exists m, 0 < m /\ forall d, In d D -> m <= dotq L0 d) as (m & M & Least).
  { clear Ne. induction D as [| e E IH]; [exists 1; cbn; split; [lra | tauto] |].
    destruct IH as (m & M & Least); [intros; apply H0; cbn; auto |].
    assert (0 < dotq L0 e) by (apply H0; cbn; auto).
    destruct (Qlt_le_dec m (dotq L0 e)).
    - exists m. split; auto. intros d [<- | I]; auto. lra.
    - exists (dotq L0 e). split; auto. intros d [<- | I]; [lra |]. apply Least in I. lra. }
  set (L1 := moved (Triple 0 0 0) (/ m) L0).
  assert (forall d, In d D -> 1 <= dotq L1 d) as H1.
  { intros d I. apply Least in I. assert (dotq L1 d == dotq L0 d / m) as ->.
    { unfold L1, moved, dotq; cbn. field. lra. }
    apply Qle_shift_div_l; lra. }
  clearbody L1. clear m M Least L0 H0.
  destruct (slide_either L1 L1 H1) as (L2 & H2 & _ & d1 & I1 & _ & T1).
  { destruct D as [| e E]; [tauto |]. exists e. split; [cbn; auto |].
    assert (1 <= dotq L1 e) by (apply H1; cbn; auto). lra. }
  clear L1 H1.
  destruct (search D (fun d => zero_dec (cofactors d1 d))) as [(d & I & N) | Line];
    [| exists L2; split; auto; now apply (held_on_line L2 d1)].
  set (v := cofactors (cofactors d1 d) d1).
  assert (forall c, dotq v c == dotq (cofactors d1 d) (cofactors d1 c)) as Hv by (intros c; unfold v; coordinates).
  destruct (slide_either L2 v H2) as (L3 & H3 & K3 & d2 & I2 & N2 & T2).
  { exists d. split; auto. rewrite Hv. apply positive_square in N. lra. }
  assert (dotq L3 d1 == 1) as T1' by (rewrite K3; auto; unfold v; coordinates).
  assert (~ zero (cofactors d1 d2)) as N12.
  { intros (Ex & Ey & Ez). apply N2. rewrite Hv. unfold dotq. rewrite Ex, Ey, Ez. ring. }
  destruct (search D (fun d => Qeq_dec (dotq (cofactors d1 d2) d) 0)) as [(c & J & Nc) | Plane];
    [| exists L3; split; auto; now apply (held_in_plane L3 d1 d2)].
  destruct (slide_either L3 (cofactors d1 d2) H3) as (L4 & H4 & K4 & d3 & I3 & N3 & T3); [eauto |].
  exists L4. split; auto. apply (held_by_three L4 d1 d2 d3); auto.
  - rewrite K4; auto. coordinates.
  - rewrite K4; auto. coordinates.
Qed.

(** L is at right angles to the sides between the vertices that hold it. *)
Lemma held_level L a b a' b' : (forall d, In d D -> 1 <= dotq L d) -> In a A -> In b B -> In a' A -> In b' B ->
  dotq L (minus a b) == 1 -> dotq L (minus a' b') == 1 -> dotq L (minus a a') == 0 /\ dotq L (minus b b') == 0.
Proof.
  intros H HA HB HA' HB' T T'.
  assert (1 <= dotq L (minus a b')) as S by (apply H, in_differences; eauto).
  assert (1 <= dotq L (minus a' b)) as S' by (apply H, in_differences; eauto).
  rewrite !dotq_minus in *. split; lra.
Qed.
Lemma plane_level N a a' b b' : (forall d, In d D -> dotq N d == 0) -> In a A -> In a' A -> In b B -> In b' B ->
  dotq N (minus a a') == 0 /\ dotq N (minus b b') == 0.
Proof.
  intros H HA HA' HB HB'.
  assert (dotq N (minus a b) == 0) by (apply H, in_differences; eauto).
  assert (dotq N (minus a' b) == 0) by (apply H, in_differences; eauto).
  assert (dotq N (minus a b') == 0) by (apply H, in_differences; eauto).
  rewrite !dotq_minus in *. split; lra.
Qed.

(** All of A on one side of a, or level with it, all of B beyond: what the hardware asks of an in-plane axis *)
Definition faces (A B : list point) (a w : point) : Prop :=
  ((forall v, In v A -> dotq w v <= dotq w a) /\ (forall u, In u B -> dotq w a < dotq w u)) \/
  ((forall v, In v A -> dotq w a <= dotq w v) /\ (forall u, In u B -> dotq w u < dotq w a)).

(** The kinds of axes that polytopes need: products of two sides, each of A or of B; in a plane N through all
    differences, products of a side with a unit vector; on a line d of all differences, unit vectors. *)
Inductive listed : Prop :=
| by_a a a' a'' : In a A -> In a' A -> In a'' A -> separates A B (cofactors (minus a a') (minus a a'')) -> listed
| by_b b b' b'' : In b B -> In b' B -> In b'' B -> separates A B (cofactors (minus b b') (minus b b'')) -> listed
| by_both a a' b b' : In a A -> In a' A -> In b B -> In b' B ->
    separates A B (cofactors (minus a a') (minus b b')) -> listed
| in_plane_a N a a' : ~ zero N -> (forall d, In d D -> dotq N d == 0) -> In a A -> In a' A ->
    (forall k, ~ dotq N (unit k) == 0 -> separates A B (cofactors (minus a a') (unit k)) /\
      faces A B a (cofactors (minus a a') (unit k))) -> listed
| in_plane_b N b b' : ~ zero N -> (forall d, In d D -> dotq N d == 0) -> In b B -> In b' B ->
    (forall k, ~ dotq N (unit k) == 0 -> separates A B (cofactors (minus b b') (unit k)) /\
      faces B A b (cofactors (minus b b') (unit k))) -> listed
| on_line d1 k : In d1 D -> ~ zero d1 -> (forall d, In d D -> zero (cofactors d1 d)) -> separates A B (unit k) -> listed.

Lemma separates_product L u v : (forall d, In d D -> 1 <= dotq L d) -> dotq L u == 0 -> dotq L v == 0 ->
  ~ zero (cofactors u v) -> separates A B (cofactors u v).
Proof.
  intros H U V N. apply positive_square in N.
  apply (separates_by L _ (dotq (cofactors u v) (cofactors u v)) (dotq L (cofactors u v))); [lra | auto |].
  intros d _. now apply parallel.
Qed.

Lemma in_plane_parallel L N e k : ~ zero N -> ~ zero e -> dotq L e == 0 -> dotq N e == 0 -> ~ dotq N (unit k) == 0 ->
  exists al be, ~ al == 0 /\ forall d, dotq N d == 0 -> al * dotq L d == be * dotq (cofactors e (unit k)) d.
Proof.
  intros Nn Ne Le Pe K. apply positive_square in Nn, Ne.
  set (g := cofactors e N). set (nu := dotq N (unit k)) in *.
  assert (0 < dotq g g) as G.
  { assert (dotq g g == dotq e e * dotq N N - dotq N e * dotq N e) as -> by (unfold g; coordinates).
    rewrite Pe. nra. }
  exists (nu * dotq g g), (dotq L g * dotq N N). split.
  { intros E. assert (nu == 0) by nra. auto. }
  intros d I.
  set (M := moved (moved (Triple 0 0 0) (dotq N N) L) (- dotq L N) N).
  assert (forall p, dotq M p == dotq N N * dotq L p - dotq L N * dotq N p) as HM.
  { intros p. unfold M, moved, dotq; cbn. ring. }
  assert (dotq g g * dotq M d == dotq M g * dotq g d) as E1.
  { apply parallel; rewrite HM; [rewrite Le, Pe; ring | ring]. }
  assert (dotq N g == 0) as Ng by (unfold g; coordinates).
  rewrite !HM, I, Ng in E1.
  assert (dotq N N * dotq (cofactors d e) (unit k) == dotq N (cofactors d e) * nu) as E2.
  { now apply parallel_product. }
  assert (dotq (cofactors d e) (unit k) == dotq (cofactors e (unit k)) d) as F by (coordinates).
  assert (dotq N (cofactors d e) == dotq g d) as F' by (unfold g; coordinates).
  rewrite F, F' in E2.
  set (n := dotq N N) in *. set (G' := dotq g g) in *. set (l := dotq L d) in *. set (w := dotq (cofactors e (unit k)) d) in *.
  set (gd := dotq g d) in *. set (Lg := dotq L g) in *.
  assert (G' * l == Lg * gd) as E3 by nra.
  assert (nu * G' * l == nu * (G' * l)) as -> by ring. rewrite E3.
  assert (Lg * n * w == Lg * (n * w)) as -> by ring. rewrite E2. ring.
Qed.

Lemma separates_in_plane L N e k : (forall d, In d D -> 1 <= dotq L d) -> ~ zero N -> ~ zero e ->
  (forall d, In d D -> dotq N d == 0) -> dotq L e == 0 -> dotq N e == 0 -> ~ dotq N (unit k) == 0 ->
  separates A B (cofactors e (unit k)).
Proof.
  intros H Nn Ne P Le Pe K. destruct (in_plane_parallel L N e k Nn Ne Le Pe K) as (al & be & Al & E).
  apply (separates_by L _ al be); auto.
Qed.

Lemma faces_in_plane vs us o u0 L N e k : In u0 us -> ~ zero N -> ~ zero e -> dotq L e == 0 -> dotq N e == 0 -> ~ dotq N (unit k) == 0 ->
  (forall v, In v vs -> dotq N (minus v o) == 0) -> (forall u, In u us -> dotq N (minus u o) == 0) ->
  (forall v, In v vs -> 0 <= dotq L (minus v o)) -> (forall u, In u us -> dotq L (minus u o) < 0) ->
  faces vs us o (cofactors e (unit k)).
Proof.
  intros I0 Nn Ne Le Pe K Nv Nu Lv Lu. destruct (in_plane_parallel L N e k Nn Ne Le Pe K) as (al & be & Al & E).
  set (w := cofactors e (unit k)) in *.
  assert (0 < al * al) as Sq by (destruct (Q_dec al 0) as [[|]|]; [nra | nra | tauto]).
  assert (forall p, dotq N p == 0 -> al * al * dotq L p == al * be * dotq w p) as F.
  { intros p Z. apply E in Z. setoid_replace (al * be * dotq w p) with (al * (be * dotq w p)) by ring. rewrite <- Z. ring. }
  clear E. set (sq := al * al) in *. set (g := al * be) in *.
  assert (forall v, In v vs -> 0 <= g * (dotq w v - dotq w o)) as Gv.
  { intros v I. rewrite <- dotq_minus, <- F by auto. apply Lv in I. nra. }
  assert (forall u, In u us -> g * (dotq w u - dotq w o) < 0) as Gu.
  { intros u I. rewrite <- dotq_minus, <- F by auto. apply Lu in I. nra. }
  assert (~ g == 0) by (intros Z; apply Gu in I0; rewrite Z in I0; lra).
  clearbody g w. destruct (Qlt_le_dec 0 g) as [Pos | Neg]; [| assert (g < 0) by lra].
  - right. split; [intros v I; apply Gv in I | intros u I; apply Gu in I]; nra.
  - left. split; [intros v I; apply Gv in I | intros u I; apply Gu in I]; nra.
Qed.

Theorem apart_listed : A <> [] -> B <> [] -> ~ meet A B -> listed.
Proof.
  intros NA NB H. destruct (apart_axis A B H) as (L0 & H0).
  destruct (hold L0) as (L & H1 & Held); [| auto |].
  { unfold D, differences. destruct A as [| a A'], B as [| b B']; try tauto. discriminate. }
  destruct Held as [d1 d2 d3 I1 I2 I3 T1 T2 T3 Det | d1 d2 I1 I2 T1 T2 N P | d1 I1 T1 Line].
  - apply in_differences in I1, I2, I3. destruct I1 as (a1 & b1 & A1 & B1 & <-), I2 as (a2 & b2 & A2 & B2 & <-),
      I3 as (a3 & b3 & A3 & B3 & <-).
    destruct (held_level L a1 b1 a2 b2 H1 A1 B1 A2 B2 T1 T2) as (U2 & V2).
    destruct (held_level L a1 b1 a3 b3 H1 A1 B1 A3 B3 T1 T3) as (U3 & V3).
    destruct (zero_dec (cofactors (minus a1 a2) (minus a1 a3))) as [(X1 & Y1 & Z1) | N1].
    2: { apply (by_a a1 a2 a3); auto. now apply (separates_product L). }
    destruct (zero_dec (cofactors (minus b1 b2) (minus b1 b3))) as [(X2 & Y2 & Z2) | N2].
    2: { apply (by_b b1 b2 b3); auto. now apply (separates_product L). }
    destruct (zero_dec (cofactors (minus a1 a2) (minus b1 b3))) as [(X3 & Y3 & Z3) | N3].
    2: { apply (by_both a1 a2 b1 b3); auto. now apply (separates_product L). }
    destruct (zero_dec (cofactors (minus a1 a3) (minus b1 b2))) as [(X4 & Y4 & Z4) | N4].
    2: { apply (by_both a1 a3 b1 b2); auto. now apply (separates_product L). }
    exfalso. apply Det. set (d := minus a1 b1).
    assert (dotq (cofactors d (minus a2 b2)) (minus a3 b3)
      == dotq d (cofactors (minus a1 a2) (minus a1 a3)) + dotq d (cofactors (minus b1 b2) (minus b1 b3))
         - dotq d (cofactors (minus a1 a2) (minus b1 b3)) + dotq d (cofactors (minus a1 a3) (minus b1 b2))) as ->.
    { unfold d. coordinates. }
    unfold dotq at 1 2 3 4. rewrite X1, Y1, Z1, X2, Y2, Z2, X3, Y3, Z3, X4, Y4, Z4. ring.
  - set (M := cofactors d1 d2) in *. pose proof N as N'. apply positive_square in N'.
    apply in_differences in I1, I2. destruct I1 as (a1 & b1 & A1 & B1 & E1), I2 as (a2 & b2 & A2 & B2 & E2).
    rewrite <- E1 in T1. rewrite <- E2 in T2.
    destruct (held_level L a1 b1 a2 b2 H1 A1 B1 A2 B2 T1 T2) as (U & V).
    destruct (plane_level M a1 a2 b1 b2 P A1 A2 B1 B2) as (U' & V').
    destruct (zero_dec (minus a1 a2)) as [(X1 & Y1 & Z1) | Na].
    2: { apply (in_plane_a M a1 a2); auto. intros k K. split; [now apply (separates_in_plane L M) |].
      apply (faces_in_plane A B a1 b1 L M); auto.
      - intros v I. now apply (plane_level M v a1 b1 b1).
      - intros u I. assert (dotq M (minus a1 u) == 0) as E by (apply P, in_differences; eauto).
        rewrite dotq_minus in *. lra.
      - intros v I. assert (1 <= dotq L (minus v b1)) as E by (apply H1, in_differences; eauto).
        rewrite dotq_minus in *. lra.
      - intros u I. assert (1 <= dotq L (minus a1 u)) as E by (apply H1, in_differences; eauto).
        rewrite dotq_minus in *. lra. }
    destruct (zero_dec (minus b1 b2)) as [(X2 & Y2 & Z2) | Nb].
    2: { apply (in_plane_b M b1 b2); auto. intros k K. split; [now apply (separates_in_plane L M) |].
      apply (faces_in_plane B A b1 a1 (opposite L) M); auto.
      - rewrite dotq_opposite, V. ring.
      - intros v I. now apply (plane_level M a1 a1 v b1).
      - intros u I. assert (dotq M (minus u b1) == 0) as E by (apply P, in_differences; eauto). auto.
      - intros v I. assert (1 <= dotq L (minus a1 v)) as E by (apply H1, in_differences; eauto).
        rewrite dotq_opposite. rewrite dotq_minus in *. lra.
      - intros u I. assert (1 <= dotq L (minus u b1)) as E by (apply H1, in_differences; eauto).
        rewrite dotq_opposite. rewrite dotq_minus in *. lra. }
    exfalso. apply N. unfold M, zero. rewrite <- E1, <- E2. unfold cofactors, minus in *; cbn in *.
    assert (x a2 == x a1) as -> by lra. assert (y a2 == y a1) as -> by lra. assert (z a2 == z a1) as -> by lra.
    assert (x b2 == x b1) as -> by lra. assert (y b2 == y b1) as -> by lra. assert (z b2 == z b1) as -> by lra.
    repeat split; ring.
  - assert (~ zero d1) as Nz.
    { intros (Ex & Ey & Ez). unfold dotq in T1. rewrite Ex, Ey, Ez in T1. lra. }
    destruct (component_not_zero d1 Nz) as (k & K).
    apply (on_line d1 k); auto. apply (separates_by L _ (dotq (unit k) d1) 1); auto.
    intros d I. apply Line in I. destruct I as (Ex & Ey & Ez).
    assert (dotq (unit k) d1 * dotq L d - dotq L d1 * dotq (unit k) d
            == dotq (cofactors L (unit k)) (cofactors d d1)) as E by coordinates.
    assert (dotq (cofactors L (unit k)) (cofactors d d1) == - dotq (cofactors L (unit k)) (cofactors d1 d)) as E' by coordinates.
    unfold dotq at 2 in E'. rewrite Ex, Ey, Ez in E'. rewrite T1 in E. lra.
Qed.
End Axis.

(** Axes prove what they say. *)
Lemma greatest (f : point -> Q) vs : vs <> [] -> exists v, In v vs /\ forall u, In u vs -> f u <= f v.
Proof.
  induction vs as [| v vs IH]; [tauto | intros _]. destruct vs as [| w vs].
  { exists v. cbn. split; [auto |]. intros u [<- | []]. lra. }
  destruct IH as (m & I & M); [discriminate |]. destruct (Qlt_le_dec (f m) (f v)).
  - exists v. split; [now left |]. intros u [<- | J]; [lra |]. apply M in J. lra.
  - exists m. split; [now right |]. intros u [<- | J]; auto.
Qed.
Lemma hull_not_empty vs p : hull vs p -> vs <> [].
Proof. intros ([| w ws] & Len & _ & S & _) ->; [cbn in S; lra | discriminate]. Qed.
Lemma hulls_less L C D p q : (forall a b, In a C -> In b D -> dotq L a < dotq L b) -> hull C p -> hull D q ->
  dotq L p < dotq L q.
Proof.
  intros H P Q.
  destruct (greatest (dotq L) C (hull_not_empty _ _ P)) as (c & IC & Max).
  destruct (greatest (fun v => - dotq L v) D (hull_not_empty _ _ Q)) as (d & ID & Min).
  apply (hull_le L (dotq L c)) in P; auto.
  apply (hull_ge L (dotq L d)) in Q; [| intros v V; apply Min in V; lra].
  pose proof (H c d IC ID). lra.
Qed.
Lemma separates_apart A B L : separates A B L -> ~ meet A B.
Proof.
  intros S (p & q & P & Q & Ex & Ey & Ez). cbn in *.
  assert (dotq L p == dotq L q) as E by (unfold dotq; rewrite Ex, Ey, Ez; ring).
  destruct S as [S | S].
  - pose proof (hulls_less L A B p q S P Q). lra.
  - pose proof (hulls_less L B A q p (fun b a HB HA => S a b HA HB) Q P). lra.
Qed.

(** * Two triangles *)

Section Triangles.
Variables (TA TB : triangle).
Let A := corners TA.
Let B := corners TB.
Let D := differences A B.

Lemma separates_multiple u w s : (forall p, dotq u p == s * dotq w p) -> separates A B u -> separates A B w.
Proof.
  intros E [S | S]; destruct (Qlt_le_dec 0 s) as [P | P];
    [left | right | right | left]; intros a b HA HB; pose proof (S a b HA HB) as H; rewrite !E in H; nra.
Qed.
Lemma not_zero_axis w : separates A B w -> ~ zero w.
Proof.
  intros S (Ex & Ey & Ez). assert (forall p, dotq w p == 0) as Z by (intros p; unfold dotq; rewrite Ex, Ey, Ez; ring).
  assert (exists a b, In a A /\ In b B) as (a & b & HA & HB).
  { unfold A, B, corners. destruct TA as ((a, ?), ?), TB as ((b, ?), ?). exists a, b. cbn. auto. }
  destruct S as [S | S]; pose proof (S a b HA HB) as H; rewrite !Z in H; lra.
Qed.
End Triangles.

Lemma side_of (T : triangle) a a' : In a (corners T) -> In a' (corners T) ->
  zero (minus a a') \/ exists e s, In e (edges T) /\ (s == 1 \/ s == - (1)) /\
    forall p, dotq (minus a a') p == s * dotq e p.
Proof.
  destruct T as ((p, q), r). cbn [corners edges].
  intros [<- | [<- | [<- | []]]] [<- | [<- | [<- | []]]];
    try (left; unfold zero, minus; cbn; repeat split; ring); right.
  all: match goal with |- context [minus ?u ?v] =>
    (exists (minus u v), 1; split; [cbn; tauto |]; split; [left; reflexivity |]; intros; ring) ||
    (exists (minus v u), (- (1)); split; [cbn; tauto |]; split; [right; reflexivity |]; intros; coordinates) end.
Qed.
Lemma normal_of (T : triangle) a a' a'' : In a (corners T) -> In a' (corners T) -> In a'' (corners T) ->
  exists s, forall p, dotq (cofactors (minus a a') (minus a a'')) p == s * dotq (normal T) p.
Proof.
  destruct T as ((p, q), r). cbn [corners normal].
  intros [<- | [<- | [<- | []]]] [<- | [<- | [<- | []]]] [<- | [<- | [<- | []]]];
    ((exists 0; intros; solve [coordinates]) || (exists 1; intros; solve [coordinates])
     || (exists (- (1)); intros; solve [coordinates])).
Qed.

Lemma in_cross_axes es fs w : In w (cross_axes es fs) <-> exists e f, In e es /\ In f fs /\ cofactors e f = w.
Proof.
  unfold cross_axes. rewrite in_flat_map. split.
  - intros (e & E & I). apply in_map_iff in I. destruct I as (f & <- & F). eauto.
  - intros (e & f & E & F & <-). exists e. split; auto. now apply in_map.
Qed.

(** All that a programme may do: the general axes; in a common plane the six in-plane ones of any component in which
    nA is not zero; for a degenerate triangle those of [degenerate_axes]. *)
Definition degenerate (A B : triangle) : Prop := zero (normal A) \/ zero (normal B).
Definition coplanar (A B : triangle) : Prop :=
  forall a b, In a (corners A) -> In b (corners B) -> dotq (normal A) (minus a b) == 0.
Definition some_axis (A B : triangle) (ws : list point) : Prop :=
  exists w, In w ws /\ separates (corners A) (corners B) w.

Lemma separates_cofactors A B e f u v s t : (forall p, dotq u p == s * dotq e p) -> (forall p, dotq v p == t * dotq f p) ->
  separates (corners A) (corners B) (cofactors u v) -> separates (corners A) (corners B) (cofactors e f).
Proof.
  intros U V. apply (separates_multiple A B _ _ (s * t)). intros p.
  rewrite triple_product, U, <- triple_product.
  assert (dotq (cofactors e v) p == dotq v (cofactors p e)) as -> by coordinates.
  rewrite V. coordinates.
Qed.
Lemma cofactors_zero u v : zero u \/ zero v -> zero (cofactors u v).
Proof. unfold zero, cofactors; cbn. intros [(-> & -> & ->) | (-> & -> & ->)]; repeat split; ring. Qed.

(** The axes of [listed] that need no common plane are general ones. *)
Lemma general_by_a A B a a' a'' : In a (corners A) -> In a' (corners A) -> In a'' (corners A) ->
  separates (corners A) (corners B) (cofactors (minus a a') (minus a a'')) -> some_axis A B (general_axes A B).
Proof.
  intros I I' I'' S. destruct (normal_of A a a' a'' I I' I'') as (s & E). exists (normal A).
  split; [cbn; auto | now apply (separates_multiple A B _ _ s E)].
Qed.
Lemma general_by_b A B b b' b'' : In b (corners B) -> In b' (corners B) -> In b'' (corners B) ->
  separates (corners A) (corners B) (cofactors (minus b b') (minus b b'')) -> some_axis A B (general_axes A B).
Proof.
  intros I I' I'' S. destruct (normal_of B b b' b'' I I' I'') as (s & E). exists (normal B).
  split; [cbn; auto | now apply (separates_multiple A B _ _ s E)].
Qed.
Lemma general_by_both A B a a' b b' : In a (corners A) -> In a' (corners A) -> In b (corners B) -> In b' (corners B) ->
  separates (corners A) (corners B) (cofactors (minus a a') (minus b b')) -> some_axis A B (general_axes A B).
Proof.
  intros I I' J J' S.
  destruct (side_of A a a' I I') as [Z | (e & s & IE & _ & E)];
    [exfalso; apply (not_zero_axis A B _ S), cofactors_zero; auto |].
  destruct (side_of B b b' J J') as [Z | (f & t & IF & _ & F)];
    [exfalso; apply (not_zero_axis A B _ S), cofactors_zero; auto |].
  exists (cofactors e f).
  split; [apply in_or_app; right; apply in_cross_axes; eauto | now apply (separates_cofactors A B e f _ _ s t E F)].
Qed.

(** The one side of an edge at which the hardware looks. *)
Definition one_sided (d : component) (A B : triangle) : Prop :=
  (exists a a', In a (corners A) /\ In a' (corners A) /\
     faces (corners A) (corners B) a (cofactors (minus a a') (unit d))) \/
  (exists b b', In b (corners B) /\ In b' (corners B) /\
     faces (corners B) (corners A) b (cofactors (minus b b') (unit d))).

(** Degenerate triangles, too: if no general axis separates, their boxes do, or one side of an edge is enough. *)
Theorem one_side_or_boxes A B : ~ meet (corners A) (corners B) ->
  some_axis A B (general_axes A B) \/ (exists k, separates (corners A) (corners B) (unit k)) \/
  (exists k, one_sided k A B).
Proof.
  intros H.
  assert (corners A <> [] /\ corners B <> []) as (NA & NB).
  { destruct A as ((?, ?), ?), B as ((?, ?), ?). split; discriminate. }
  destruct (apart_listed (corners A) (corners B) NA NB H) as
    [a a' a'' I I' I'' S | b b' b'' I I' I'' S | a a' b b' I I' J J' S
     | N a a' Nz P I I' S | N b b' Nz P I I' S | d1 k I Nz P S].
  - left. now apply (general_by_a A B a a' a'').
  - left. now apply (general_by_b A B b b' b'').
  - left. now apply (general_by_both A B a a' b b').
  - right; right. destruct (component_not_zero N Nz) as (k & K). rewrite dotq_comm in K.
    exists k. left. exists a, a'. repeat (split; auto). now apply S.
  - right; right. destruct (component_not_zero N Nz) as (k & K). rewrite dotq_comm in K.
    exists k. right. exists b, b'. repeat (split; auto). now apply S.
  - right; left. now exists k.
Qed.

Theorem axes_one_sided A B : ~ meet (corners A) (corners B) ->
  some_axis A B (general_axes A B) \/
  (degenerate A B /\ some_axis A B (degenerate_axes A B)) \/
  (~ degenerate A B /\ coplanar A B /\
   forall d, ~ dotq (normal A) (unit d) == 0 -> some_axis A B (in_plane_axes d A B) /\ one_sided d A B).
Proof.
  intros H.
  assert (corners A <> [] /\ corners B <> []) as (NA & NB).
  { destruct A as ((?, ?), ?), B as ((?, ?), ?). split; discriminate. }
  assert (exists a a' a'', In a (corners A) /\ In a' (corners A) /\ In a'' (corners A) /\
      normal A = cofactors (minus a' a) (minus a'' a)) as HN.
  { destruct A as ((p, q), r). exists p, q, r.
    split; [| split; [| split]]; [cbn; auto .. | reflexivity]. }
  assert (exists b, In b (corners B)) as (b0 & IB0) by (destruct B as ((b, ?), ?); exists b; cbn; auto).
  assert (forall N, ~ zero N -> (forall d, In d (differences (corners A) (corners B)) -> dotq N d == 0) ->
    forall p, dotq N N * dotq (normal A) p == dotq N (normal A) * dotq N p) as Along.
  { intros N Nz P p. destruct HN as (a & a' & a'' & HA & HA' & HA'' & ->).
    apply parallel_product.
    - now apply (plane_level (corners A) (corners B) N a' a b0 b0).
    - now apply (plane_level (corners A) (corners B) N a'' a b0 b0). }
  assert (forall N, ~ zero N -> (forall d, In d (differences (corners A) (corners B)) -> dotq N d == 0) ->
    coplanar A B) as Co.
  { intros N Nz P a b HA HB. apply positive_square in Nz as Sq.
    assert (dotq N (minus a b) == 0) as E by (apply P, in_differences; eauto).
    pose proof (Along N Nz P (minus a b)) as F. rewrite E in F. nra. }
  assert (forall N d, ~ zero N -> (forall d, In d (differences (corners A) (corners B)) -> dotq N d == 0) ->
    ~ dotq (normal A) (unit d) == 0 -> ~ dotq N (unit d) == 0) as Comp.
  { intros N d Nz P K E. apply positive_square in Nz as Sq. pose proof (Along N Nz P (unit d)) as F. rewrite E in F.
    apply K. nra. }
  assert ({degenerate A B} + {~ degenerate A B}) as [Deg | Deg].
  { unfold degenerate. destruct (zero_dec (normal A)); [left; auto |]. destruct (zero_dec (normal B)); [left; auto |].
    right. tauto. }
  all: destruct (apart_listed (corners A) (corners B) NA NB H) as
    [a a' a'' I I' I'' S | b b' b'' I I' I'' S | a a' b b' I I' J J' S
     | N a a' Nz P I I' S | N b b' Nz P I I' S | d1 k I Nz P S].
  all: try (left; now apply (general_by_a A B a a' a'')).
  all: try (left; now apply (general_by_b A B b b' b'')).
  all: try (left; now apply (general_by_both A B a a' b b')).
  - right; left. split; auto. destruct (component_not_zero N Nz) as (k & K). rewrite dotq_comm in K.
    destruct (side_of A a a' I I') as [Z | (e & s & IE & _ & E)];
      [exfalso; apply (not_zero_axis A B _ (proj1 (S k K))), cofactors_zero; auto |].
    exists (cofactors e (unit k)). split.
    + apply in_or_app; left. apply in_cross_axes. exists e, (unit k). destruct k; cbn; auto 6.
    + apply (separates_cofactors A B e (unit k) (minus a a') (unit k) s 1 E); [intros; ring | apply S; auto].
  - right; left. split; auto. destruct (component_not_zero N Nz) as (k & K). rewrite dotq_comm in K.
    destruct (side_of B b b' I I') as [Z | (e & s & IE & _ & E)];
      [exfalso; apply (not_zero_axis A B _ (proj1 (S k K))), cofactors_zero; auto |].
    exists (cofactors e (unit k)). split.
    + apply in_or_app; right. apply in_or_app; left. apply in_cross_axes. exists e, (unit k). destruct k; cbn; auto 6.
    + apply (separates_cofactors A B e (unit k) (minus b b') (unit k) s 1 E); [intros; ring | apply S; auto].
  - right; left. split; auto. exists (unit k). split; auto.
    apply in_or_app; right. apply in_or_app; right. destruct k; cbn; auto.
  - right; right. split; auto. split; [now apply (Co N) |]. intros d K. apply (Comp N d Nz P) in K.
    split; [| left; exists a, a'; split; auto; split; auto; now apply S].
    destruct (side_of A a a' I I') as [Z | (e & s & IE & _ & E)];
      [exfalso; apply (not_zero_axis A B _ (proj1 (S d K))), cofactors_zero; auto |].
    exists (cofactors e (unit d)). split.
    + apply in_or_app; left. apply in_cross_axes. exists e, (unit d). cbn; auto.
    + apply (separates_cofactors A B e (unit d) (minus a a') (unit d) s 1 E); [intros; ring | apply S; auto].
  - right; right. split; auto. split; [now apply (Co N) |]. intros d K. apply (Comp N d Nz P) in K.
    split; [| right; exists b, b'; split; auto; split; auto; now apply S].
    destruct (side_of B b b' I I') as [Z | (e & s & IE & _ & E)];
      [exfalso; apply (not_zero_axis A B _ (proj1 (S d K))), cofactors_zero; auto |].
    exists (cofactors e (unit d)). split.
    + apply in_or_app; right. apply in_cross_axes. exists e, (unit d). cbn; auto.
    + apply (separates_cofactors A B e (unit d) (minus b b') (unit d) s 1 E); [intros; ring | apply S; auto].
  - exfalso. apply Deg. left.
    assert (forall d, In d (differences (corners A) (corners B)) -> forall q, dotq (cofactors d1 d) q == 0) as Q.
    { intros d J q. apply P in J. destruct J as (Ex & Ey & Ez). unfold dotq. rewrite Ex, Ey, Ez. ring. }
    assert (forall a a', In a (corners A) -> In a' (corners A) -> forall q, dotq (cofactors d1 (minus a' a)) q == 0) as Q'.
    { intros a a' HA HA' q.
      assert (dotq (cofactors d1 (minus a b0)) q == 0) as E by (apply Q, in_differences; eauto).
      assert (dotq (cofactors d1 (minus a' b0)) q == 0) as E' by (apply Q, in_differences; eauto).
      assert (dotq (cofactors d1 (minus a' a)) q
        == dotq (cofactors d1 (minus a' b0)) q - dotq (cofactors d1 (minus a b0)) q) as -> by coordinates.
      rewrite E, E'. ring. }
    destruct HN as (a & a' & a'' & HA & HA' & HA'' & ->).
    apply positive_square in Nz. apply zero_products. intros p.
    pose proof (lagrange d1 (minus a' a) (cofactors (minus a'' a) p)) as G.
    rewrite <- triple_product in G. rewrite <- (triple_product d1), Q' in G by auto.
    assert (dotq (cofactors (minus a' a) d1) (cofactors (cofactors (minus a'' a) p) d1)
      == - dotq (cofactors d1 (minus a' a)) (cofactors (cofactors (minus a'' a) p) d1)) as E by coordinates.
    rewrite E, Q' in G by auto. nra.
Qed.

Corollary axes_complete A B : ~ meet (corners A) (corners B) ->
  some_axis A B (general_axes A B) \/
  (degenerate A B /\ some_axis A B (degenerate_axes A B)) \/
  (~ degenerate A B /\ coplanar A B /\
   forall d, ~ dotq (normal A) (unit d) == 0 -> some_axis A B (in_plane_axes d A B)).
Proof.
  intros H. apply axes_one_sided in H. destruct H as [H | [H | (N & C & H)]]; auto.
  right; right. split; auto. split; auto. intros d K. now apply H.
Qed.

(** The theorem: nA, nB and the nine products, or the programme of a special case, decide. *)
Theorem axes_decide A B : ~ meet (corners A) (corners B) <->
  some_axis A B (general_axes A B) \/
  (degenerate A B /\ some_axis A B (degenerate_axes A B)) \/
  (~ degenerate A B /\ coplanar A B /\
   forall d, ~ dotq (normal A) (unit d) == 0 -> some_axis A B (in_plane_axes d A B)).
Proof.
  split; [apply axes_complete |].
  intros [(w & _ & S) | [(_ & w & _ & S) | (Deg & _ & H)]]; try now apply (separates_apart _ _ w).
  destruct (component_not_zero (normal A)) as (d & K); [intros Z; apply Deg; now left |].
  destruct (H d) as (w & _ & S); [now rewrite dotq_comm |]. now apply (separates_apart _ _ w).
Qed.

(** Seventeen axes: triangles with normals, d any component in which nA is not zero, as the largest one. *)
Corollary seventeen_axes A B d : ~ zero (normal A) -> ~ zero (normal B) -> ~ dotq (normal A) (unit d) == 0 ->
  (~ meet (corners A) (corners B) <-> some_axis A B (general_axes A B ++ in_plane_axes d A B)).
Proof.
  intros NA NB K. split.
  - intros H. apply axes_complete in H.
    destruct H as [(w & I & S) | [(Deg & _) | (_ & _ & H)]].
    + exists w. split; [apply in_or_app; auto | auto].
    + destruct Deg; tauto.
    + destruct (H d K) as (w & I & S). exists w. split; [apply in_or_app; auto | auto].
  - intros (w & _ & S). now apply (separates_apart _ _ w).
Qed.
Lemma seventeen A B d : length (general_axes A B ++ in_plane_axes d A B) = 17%nat.
Proof. destruct A as ((?, ?), ?), B as ((?, ?), ?). reflexivity. Qed.
