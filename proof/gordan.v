(* SPDX-License-Identifier: Apache-2.0 *)
(** Hulls without a common point have an axis that parts their vertices: [apart_axis] at the end, for [axes.v]. *)
Require Import ZArith QArith Lqa Lia List Bool.
From Certificates Require Import statement geometry.
Import ListNotations.
Open Scope Q_scope.

(** * Gordan's theorem: an axis with positive products, or a positive combination that is zero *)

(** Vectors are functions; the first n values count. *)
Fixpoint dotn (n : nat) (f g : nat -> Q) : Q :=
  match n with O => 0 | S n => f n * g n + dotn n f g end.

Inductive cone (D : list (nat -> Q)) : (nat -> Q) -> Prop :=
| cone_in f : In f D -> cone D f
| cone_add f g : cone D f -> cone D g -> cone D (fun i => f i + g i)
| cone_scale c f : 0 < c -> cone D f -> cone D (fun i => c * f i).

Lemma dotn_add n L f g : dotn n L (fun i => f i + g i) == dotn n L f + dotn n L g.
Proof. induction n as [| n IH]; cbn; [ring | rewrite IH; ring]. Qed.
Lemma dotn_scale n L c f : dotn n L (fun i => c * f i) == c * dotn n L f.
Proof. induction n as [| n IH]; cbn; [ring | rewrite IH; ring]. Qed.
Lemma dotn_same n L M f : (forall i, (i < n)%nat -> L i = M i) -> dotn n L f == dotn n M f.
Proof.
  induction n as [| n IH]; intros E; cbn; [reflexivity |]. rewrite IH, (E n); [reflexivity | lia |].
  intros i I. apply E. lia.
Qed.

Lemma between (lo hi : list Q) : (forall a b, In a lo -> In b hi -> a < b) ->
  exists l, (forall a, In a lo -> a < l) /\ (forall b, In b hi -> l < b).
Proof.
  intros H.
  assert (lo = [] \/ exists m, In m lo /\ forall a, In a lo -> a <= m) as M.
  { clear H. induction lo as [| a lo [-> | (m & I & B)]]; [auto | right | right].
    - exists a. cbn. split; [auto |]. intros c [<- | []]. lra.
    - destruct (Qlt_le_dec m a).
      + exists a. cbn. split; [auto |]. intros c [<- | J]; [lra |]. apply B in J. lra.
      + exists m. cbn. split; [auto |]. intros c [<- | J]; [lra |]. auto. }
  assert (hi = [] \/ exists m, In m hi /\ forall a, In a hi -> m <= a) as N.
  { clear H M. induction hi as [| a hi [-> | (m & I & B)]]; [auto | right | right].
    - exists a. cbn. split; [auto |]. intros c [<- | []]. lra.
    - destruct (Qlt_le_dec a m).
      + exists a. cbn. split; [auto |]. intros c [<- | J]; [lra |]. apply B in J. lra.
      + exists m. cbn. split; [auto |]. intros c [<- | J]; [lra |]. auto. }
  destruct M as [-> | (m & I & B)], N as [-> | (m' & I' & B')].
  - exists 0. cbn. tauto.
  - exists (m' - 1). split; [cbn; tauto |]. intros b J. apply B' in J. lra.
  - exists (m + 1). split; [| cbn; tauto]. intros b J. apply B in J. lra.
  - exists ((m + m') * (1 # 2)). assert (m < m') by auto.
    split; intros b J; [apply B in J | apply B' in J]; lra.
Qed.

Definition is_pos (a : Q) : bool := if Qlt_le_dec 0 a then true else false.
Lemma is_pos_spec a : is_pos a = true <-> 0 < a.
Proof. unfold is_pos. destruct (Qlt_le_dec 0 a); split; intros; try discriminate; auto; lra. Qed.

Lemma gordan n : forall D, (exists L, forall f, In f D -> 0 < dotn n L f) \/
  (exists f, cone D f /\ forall i, (i < n)%nat -> f i == 0).
Proof.
  induction n as [| n IH]; intros D.
  { destruct D as [| f D]; [left; exists (fun _ => 0); cbn; tauto |].
    right. exists f. split; [apply cone_in; cbn; auto | lia]. }
  set (P := filter (fun f : nat -> Q => is_pos (f n)) D).
  set (N := filter (fun f : nat -> Q => is_pos (- f n)) D).
  set (Z := filter (fun f : nat -> Q => Qeq_bool (f n) 0) D).
  set (E := Z ++ flat_map (fun f => map (fun g i => (- g n) * f i + f n * g i) N) P).
  assert (forall f, In f P <-> In f D /\ 0 < f n) as HP.
  { intros f. unfold P. rewrite filter_In, is_pos_spec. tauto. }
  assert (forall f, In f N <-> In f D /\ f n < 0) as HN.
  { intros f. unfold N. rewrite filter_In, is_pos_spec. intuition lra. }
  assert (forall f, In f Z <-> In f D /\ f n == 0) as HZ.
  { intros f. unfold Z. rewrite filter_In, Qeq_bool_iff. tauto. }
  assert (forall f g, In f P -> In g N -> In (fun i => (- g n) * f i + f n * g i) E) as HE.
  { intros f g F G. apply in_or_app. right. apply in_flat_map. exists f. split; auto.
    apply in_map_iff. exists g. auto. }
  destruct (IH E) as [(L & HL) | (f & C & F)].
  - left.
    destruct (between (map (fun f => - dotn n L f / f n) P) (map (fun g => dotn n L g / (- g n)) N)) as (l & Lo & Hi).
    { intros a b A B. apply in_map_iff in A, B. destruct A as (f & <- & F), B as (g & <- & G).
      pose proof (HL _ (HE f g F G)) as Pos. rewrite dotn_add, !dotn_scale in Pos.
      apply HP in F. apply HN in G. destruct F as (_ & F), G as (_ & G).
      apply Qlt_shift_div_l; [lra |].
      setoid_replace (- dotn n L f / f n * - g n) with ((dotn n L f * g n) / f n) by (field; lra).
      apply Qlt_shift_div_r; [auto | lra]. }
    exists (fun i => if Nat.eqb i n then l else L i). intros f F. cbn. rewrite Nat.eqb_refl.
    rewrite (dotn_same n _ L); [| intros i I; destruct (Nat.eqb_spec i n); [lia | auto]].
    destruct (Q_dec (f n) 0) as [[Neg | Pos] | Zero].
    + assert (In f N) as I by (apply HN; auto).
      assert (l < dotn n L f / (- f n)) as B by (apply Hi, in_map_iff; eauto).
      assert (l * - f n < dotn n L f); [| lra].
      setoid_replace (dotn n L f) with (dotn n L f / (- f n) * - f n) by (field; lra).
      apply Qmult_lt_compat_r; lra.
    + assert (In f P) as I by (apply HP; auto).
      assert (- dotn n L f / f n < l) as B by (apply Lo, (in_map (fun f => - dotn n L f / f n)); auto).
      assert (- dotn n L f < l * f n); [| lra].
      setoid_replace (- dotn n L f) with (- dotn n L f / f n * f n) by (field; lra).
      apply Qmult_lt_compat_r; lra.
    + rewrite Zero. assert (0 < dotn n L f); [| lra]. apply HL, in_or_app. left. apply HZ. auto.
  - right. exists f. assert (cone D f /\ f n == 0) as (C' & F').
    { clear F. induction C as [f I | f g _ (F & F0) _ (G & G0) | c f Hc _ (F & F0)].
      - apply in_app_or in I. destruct I as [I | I].
        + apply HZ in I. destruct I. split; [now apply cone_in | auto].
        + apply in_flat_map in I. destruct I as (p & Hp & I). apply in_map_iff in I. destruct I as (g & <- & Hg).
          apply HP in Hp. apply HN in Hg. destruct Hp, Hg. split; [| ring].
          apply (cone_add D (fun i => - g n * p i) (fun i => p n * g i)); apply cone_scale; try lra; now apply cone_in.
      - split; [now apply cone_add | rewrite F0, G0; ring].
      - split; [now apply cone_scale | rewrite F0; ring]. }
    split; auto. intros i I. destruct (Nat.eq_dec i n) as [-> | ]; [auto | apply F; lia].
Qed.

(** * Hulls without a common point have an axis that parts their vertices *)

Definition axis_of (L : nat -> Q) : point := Triple (L 2%nat) (L 1%nat) (L 0%nat).
Definition vector_of (p : point) (i : nat) : Q := match i with O => z p | S O => y p | _ => x p end.
Definition differences (A B : list point) : list point := flat_map (fun a => map (minus a) B) A.

Lemma in_differences A B d : In d (differences A B) <-> exists a b, In a A /\ In b B /\ minus a b = d.
Proof.
  unfold differences. rewrite in_flat_map. split.
  - intros (a & HA & I). apply in_map_iff in I. destruct I as (b & <- & HB). eauto.
  - intros (a & b & HA & HB & <-). exists a. split; auto. now apply in_map.
Qed.

Fixpoint add_weights (c d : Q) (ws us : list Q) : list Q :=
  match ws, us with w :: ws, u :: us => (c * w + d * u) :: add_weights c d ws us | _, _ => [] end.
Lemma add_weights_spec c d ws us vs : length ws = length vs -> length us = length vs ->
  length (add_weights c d ws us) = length vs /\
  weighted (add_weights c d ws us) vs == c * weighted ws vs + d * weighted us vs.
Proof.
  revert us vs; induction ws as [| w ws IH]; intros [| u us] [| v vs] H K; cbn in *; try discriminate.
  - split; [auto | ring].
  - injection H as H. injection K as K. destruct (IH us vs H K) as (E & F). split; [auto | rewrite F; ring].
Qed.
Lemma add_weights_sum c d ws us : length ws = length us -> sum (add_weights c d ws us) == c * sum ws + d * sum us.
Proof.
  revert us; induction ws as [| w ws IH]; intros [| u us] H; cbn in *; try discriminate; [ring |].
  injection H as H. rewrite (IH us H). ring.
Qed.
Lemma add_weights_nonneg c d ws us : 0 <= c -> 0 <= d -> (forall w, In w ws -> 0 <= w) -> (forall w, In w us -> 0 <= w) ->
  forall w, In w (add_weights c d ws us) -> 0 <= w.
Proof.
  intros C D. revert us; induction ws as [| w ws IH]; intros [| u us] H K v I; cbn in *; try tauto.
  destruct I as [<- | I]; [| apply (IH us); auto].
  assert (0 <= w) by auto. assert (0 <= u) by auto. nra.
Qed.

Definition blend (c d : Q) (p q : point) : point :=
  Triple (c * x p + d * x q) (c * y p + d * y q) (c * z p + d * z q).
Lemma hull_convex vs p q c d : hull vs p -> hull vs q -> 0 <= c -> 0 <= d -> c + d == 1 -> hull vs (blend c d p q).
Proof.
  intros (ws & L & P & S & X & Y & Z) (us & L' & P' & S' & X' & Y' & Z') C D E.
  exists (add_weights c d ws us). split.
  { destruct (add_weights_spec c d ws us (map x vs)) as (E' & _); [now rewrite map_length .. |]. now rewrite map_length in E'. }
  split; [now apply add_weights_nonneg |]. split; [rewrite add_weights_sum, S, S' by congruence; lra |].
  assert (forall f : point -> Q, weighted (add_weights c d ws us) (map f vs)
            == c * weighted ws (map f vs) + d * weighted us (map f vs)) as W.
  { intros f. apply add_weights_spec; now rewrite map_length. }
  rewrite !W, X, Y, Z, X', Y', Z'. cbn. repeat split; reflexivity.
Qed.
Lemma hull_vertex vs v : In v vs -> hull vs v.
Proof.
  intros I. induction vs as [| u vs IH]; [destruct I |]. destruct I as [-> | I].
  - exists (1 :: map (fun _ => 0) vs).
    assert (forall f : point -> Q, weighted (map (fun _ => 0) vs) (map f vs) == 0) as W.
    { intros f. clear IH. induction vs as [| u vs IH]; cbn; [reflexivity | rewrite IH; ring]. }
    assert (sum (map (fun _ => 0) vs) == 0) as Sum.
    { clear IH W. induction vs as [| u vs IH]; cbn; [reflexivity | rewrite IH; ring]. }
    split; [cbn; now rewrite map_length |]. split.
    { intros w [<- | J]; [lra |]. apply in_map_iff in J. destruct J as (? & <- & _). lra. }
    cbn. rewrite Sum, !W. repeat split; ring.
  - destruct (IH I) as (ws & L & P & S & X & Y & Z). exists (0 :: ws). split; [cbn; auto |].
    split; [intros w [<- | J]; [lra | auto] |]. cbn. rewrite S, X, Y, Z. repeat split; ring.
Qed.

(** k (p - q), k > 0, with p and q of the hulls *)
Definition multiple (A B : list point) (f : nat -> Q) : Prop := exists k p q, 0 < k /\ hull A p /\ hull B q /\
  f 2%nat == k * (x p - x q) /\ f 1%nat == k * (y p - y q) /\ f 0%nat == k * (z p - z q).
Lemma multiple_cone A B f : cone (map vector_of (differences A B)) f -> multiple A B f.
Proof.
  intros C. induction C as [f I | f g _ F _ G | c f Hc _ F].
  - apply in_map_iff in I. destruct I as (d & <- & I). apply in_differences in I. destruct I as (a & b & HA & HB & <-).
    exists 1, a, b. split; [lra |]. split; [now apply hull_vertex |]. split; [now apply hull_vertex |].
    cbn. repeat split; ring.
  - destruct F as (k & p & q & K & P & Q & X & Y & Z), G as (k' & p' & q' & K' & P' & Q' & X' & Y' & Z').
    assert (0 <= k / (k + k')) by (apply Qle_shift_div_l; lra).
    assert (0 <= k' / (k + k')) by (apply Qle_shift_div_l; lra).
    assert (k / (k + k') + k' / (k + k') == 1) by (field; lra).
    exists (k + k'), (blend (k / (k + k')) (k' / (k + k')) p p'), (blend (k / (k + k')) (k' / (k + k')) q q').
    split; [lra |]. split; [now apply hull_convex |]. split; [now apply hull_convex |].
    rewrite X, Y, Z, X', Y', Z'. cbn. repeat split; field; lra.
  - destruct F as (k & p & q & K & P & Q & X & Y & Z). exists (c * k), p, q. split; [nra |]. split; [auto |]. split; [auto |].
    rewrite X, Y, Z. repeat split; ring.
Qed.

Lemma apart_axis A B : ~ meet A B -> exists L, forall d, In d (differences A B) -> 0 < dotq L d.
Proof.
  intros H. destruct (gordan 3 (map vector_of (differences A B))) as [(L & HL) | (f & C & F)].
  - exists (axis_of L). intros d I. apply (in_map vector_of) in I. apply HL in I. cbn in I. unfold dotq. cbn. lra.
  - exfalso. apply H. apply multiple_cone in C. destruct C as (k & p & q & K & P & Q & X & Y & Z).
    exists p, q. split; auto. split; auto. rewrite F in X, Y, Z by lia. cbn.
    assert (forall a, 0 == k * a -> a == 0) as D by (intros a E; nra).
    apply D in X, Y, Z. repeat split; lra.
Qed.
