(* SPDX-License-Identifier: Apache-2.0 *)
(** Accepted implies true: the theorem [accepted_holds] at the end. *)
Require Import ZArith QArith Qpower Lqa Lia List Bool Permutation.
From Certificates Require Import statement checker geometry.
Import ListNotations.
Open Scope Q_scope.

(** * Scaling: vertices as integers have the relations of the vertices themselves *)

Lemma whole_value e n : fits e n = true -> inject_Z (whole e n) == value n * Qpower 2 (- e).
Proof.
  unfold fits, whole, value. destruct (Z.eqb_spec (mantissa n) 0) as [E | E].
  - rewrite E. intros _. change (inject_Z 0) with 0. ring.
  - cbn. intros L. apply Z.leb_le in L. rewrite Z.shiftl_mul_pow2 by lia.
    rewrite inject_Z_mult, Zpower_Qpower by lia. change (inject_Z 2) with 2.
    rewrite <- Qmult_assoc, <- Qpower_plus by discriminate.
    now replace (exponent n + - e)%Z with (exponent n - e)%Z by lia.
Qed.

Definition factor (ev er : Z) : Q := Qpower 2 (- (ev + er)).
Lemma factor_positive ev er : 0 < factor ev er.
Proof. unfold factor. apply Qpower_0_lt. reflexivity. Qed.

Lemma fits_items e (t : triple number) : forallb (fits e) (items t) = true ->
  fits e (x t) = true /\ fits e (y t) = true /\ fits e (z t) = true.
Proof. cbn. rewrite !andb_true_iff. tauto. Qed.

Lemma coordinate_whole ev er r v :
  forallb (fits er) (items (entries r)) = true -> fits (ev + er) (shift r) = true ->
  forallb (fits ev) (items v) = true ->
  inject_Z (coordinate_z (map3 (whole er) (entries r), whole (ev + er) (shift r)) (map3 (whole ev) v))
  == factor ev er * coordinate r v.
Proof.
  intros R S V. apply fits_items in R. apply fits_items in V. destruct R as (R1 & R2 & R3), V as (V1 & V2 & V3).
  unfold coordinate_z, dot, map3, coordinate; cbn [fst snd x y z].
  rewrite !inject_Z_plus, !inject_Z_mult, !whole_value by assumption.
  unfold factor. replace (- (ev + er))%Z with (- ev + - er)%Z by lia.
  rewrite !Qpower_plus by discriminate. ring.
Qed.

(** The points Xs are the points ps times s. *)
Definition similar (s : Q) (Xs ps : list point) : Prop :=
  length Xs = length ps /\ forall ws,
    weighted ws (map x Xs) == s * weighted ws (map x ps) /\
    weighted ws (map y Xs) == s * weighted ws (map y ps) /\
    weighted ws (map z Xs) == s * weighted ws (map z ps).

Lemma similar_map {T} s (F G : T -> point) vs :
  (forall v, In v vs -> x (F v) == s * x (G v) /\ y (F v) == s * y (G v) /\ z (F v) == s * z (G v)) ->
  similar s (map F vs) (map G vs).
Proof.
  intros H. split; [now rewrite !map_length |]. induction vs as [| v vs IH]; intros [| w ws]; cbn;
    try (repeat split; ring).
  destruct (H v (or_introl eq_refl)) as (X & Y & Z).
  destruct (IH (fun u I => H u (or_intror I)) ws) as (X' & Y' & Z').
  rewrite X, Y, Z, X', Y', Z'. repeat split; ring.
Qed.

Definition times (s : Q) (t : point) : point := Triple (s * x t) (s * y t) (s * z t).

Lemma hull_times s Xs ps p : similar s Xs ps -> hull ps p -> hull Xs (times s p).
Proof.
  intros (L & W) (ws & L' & N & S & X & Y & Z). exists ws. destruct (W ws) as (Wx & Wy & Wz).
  rewrite L. repeat split; auto; cbn; rewrite ?Wx, ?Wy, ?Wz, ?X, ?Y, ?Z; reflexivity.
Qed.
Lemma hull_divided s Xs ps p : 0 < s -> similar s Xs ps -> hull Xs p -> hull ps (times (/ s) p).
Proof.
  intros P (L & W) (ws & L' & N & S & X & Y & Z). exists ws. destruct (W ws) as (Wx & Wy & Wz).
  rewrite <- L. repeat split; auto; cbn; rewrite <- ?X, <- ?Y, <- ?Z, ?Wx, ?Wy, ?Wz; field; lra.
Qed.

Section Similar.
  Variables (s : Q) (Xs Ys ps qs : list point).
  Hypotheses (P : 0 < s) (A : similar s Xs ps) (B : similar s Ys qs).

  Lemma moved_times t : meet_moved t ps qs -> meet_moved (times s t) Xs Ys.
  Proof.
    intros (p & q & Hp & Hq & X & Y & Z). exists (times s p), (times s q).
    split; [eapply hull_times; eauto |]. split; [eapply hull_times; eauto |].
    cbn. rewrite X, Y, Z. repeat split; ring.
  Qed.
  Lemma moved_divided t : meet_moved (times s t) Xs Ys -> meet_moved t ps qs.
  Proof.
    intros (p & q & Hp & Hq & X & Y & Z). exists (times (/ s) p), (times (/ s) q).
    split; [eapply hull_divided; eauto |]. split; [eapply hull_divided; eauto |].
    cbn in *. rewrite X, Y, Z. repeat split; field; lra.
  Qed.
  Lemma moved_back t : meet_moved t Xs Ys -> meet_moved (times (/ s) t) ps qs.
  Proof.
    intros (p & q & Hp & Hq & X & Y & Z). exists (times (/ s) p), (times (/ s) q).
    split; [eapply hull_divided; eauto |]. split; [eapply hull_divided; eauto |].
    cbn in *. rewrite X, Y, Z. repeat split; ring.
  Qed.
  Lemma moved_equal t u vs us : x t == x u -> y t == y u -> z t == z u -> meet_moved t vs us -> meet_moved u vs us.
  Proof.
    intros X Y Z (p & q & Hp & Hq & E). exists p, q. split; [auto |]. split; [auto |]. now rewrite <- X, <- Y, <- Z.
  Qed.

  Lemma meet_similar : meet Xs Ys <-> meet ps qs.
  Proof.
    unfold meet. split; intros H.
    - apply moved_back in H. apply (moved_equal _ _ _ _) with (4 := H); cbn; ring.
    - apply moved_times in H. apply (moved_equal _ _ _ _) with (4 := H); cbn; ring.
  Qed.

  Lemma shorter_times eps t : shorter eps t -> shorter (s * eps) (times s t).
  Proof. unfold shorter; cbn. intros H. repeat split; nra. Qed.

  Lemma cross_similar : cross Xs Ys -> cross ps qs.
  Proof.
    intros (eps & E & H). exists (/ s * eps). assert (0 < / s) by now apply Qinv_lt_0_compat.
    split; [nra |]. intros t T. apply moved_divided, H.
    apply shorter_times in T. assert (s * (/ s * eps) == eps) as F by (field; lra).
    unfold shorter in *. now rewrite F in T.
  Qed.

  Lemma touch_similar : touch Xs Ys -> touch ps qs.
  Proof.
    intros (M & H). split; [now apply meet_similar |]. intros eps E.
    destruct (H (s * eps)) as (t & T & N); [nra |]. exists (times (/ s) t). split.
    - assert (0 < / s) by now apply Qinv_lt_0_compat. set (i := / s) in *.
      assert (i * s == 1) as F by (unfold i; field; lra). unfold shorter in *; cbn.
      assert (forall a, - (s * eps) < a /\ a < s * eps -> - eps < i * a /\ i * a < eps) as G.
      { intros a (G1 & G2). assert (i * (s * eps) == eps) by (rewrite Qmult_assoc, F; ring). split; nra. }
      repeat split; apply G; tauto.
    - intros K. apply N. apply moved_times in K. apply (moved_equal _ _ _ _) with (4 := K); cbn; field; lra.
  Qed.

  Lemma near_similar w w' strict : w' == s * w -> near w' strict Xs Ys <-> near w strict ps qs.
  Proof.
    intros W. unfold near; cbv zeta. split; intros (p & q & Hp & Hq & H).
    - exists (times (/ s) p), (times (/ s) q). split; [eapply hull_divided; eauto |].
      split; [eapply hull_divided; eauto |]. cbn. assert (0 < / s) as I by now apply Qinv_lt_0_compat. set (i := / s) in *.
      assert (w == i * w') as E by (rewrite W; unfold i; field; lra).
      assert (0 < i * i) as Pi by nra.
      set (square := (x p - x q) * (x p - x q) + (y p - y q) * (y p - y q) + (z p - z q) * (z p - z q)) in *.
      assert ((i * x p - i * x q) * (i * x p - i * x q) + (i * y p - i * y q) * (i * y p - i * y q)
              + (i * z p - i * z q) * (i * z p - i * z q) == i * i * square) as S by (unfold square; ring).
      assert (w * w == i * i * (w' * w')) as V by (rewrite E; ring).
      destruct strict; rewrite S, V; [apply Qmult_lt_l | apply Qmult_le_l]; auto.
    - exists (times s p), (times s q). split; [eapply hull_times; eauto |]. split; [eapply hull_times; eauto |].
      cbn. assert (0 < s * s) as Pi by nra.
      set (square := (x p - x q) * (x p - x q) + (y p - y q) * (y p - y q) + (z p - z q) * (z p - z q)) in *.
      assert ((s * x p - s * x q) * (s * x p - s * x q) + (s * y p - s * y q) * (s * y p - s * y q)
              + (s * z p - s * z q) * (s * z p - s * z q) == s * s * square) as S by (unfold square; ring).
      assert (w' * w' == s * s * (w * w)) as V by (rewrite W; ring).
      destruct strict; rewrite S, V; [apply Qmult_lt_l | apply Qmult_le_l]; auto.
  Qed.

  (** The translation may have a scale f of its own. *)
  Lemma along_similar f t t' : 0 < f -> x t' == f * x t -> y t' == f * y t -> z t' == f * z t ->
    meet_along t' Xs Ys <-> meet_along t ps qs.
  Proof.
    intros F X Y Z. split; intros (k & K & M).
    - exists (k * f / s). split; [apply Qlt_shift_div_l; [auto | nra] |].
      apply moved_back in M. apply (moved_equal _ _ _ _) with (4 := M); cbn; rewrite ?X, ?Y, ?Z; field; lra.
    - exists (s * k / f). split; [apply Qlt_shift_div_l; [auto | nra] |].
      apply moved_times in M. apply (moved_equal _ _ _ _) with (4 := M); cbn; rewrite ?X, ?Y, ?Z; field; lra.
  Qed.
End Similar.

(** What decides of two faces whether the certificate speaks of them: those that cross are among those that meet. *)
Definition base (k : criterion) : list point -> list point -> Prop :=
  match k with CrossingOnly => meet | _ => counts_as_contact k end.

Lemma related_similar ev er k Xs Ys ps qs : fits_criterion (ev + er) k = true ->
  similar (factor ev er) Xs ps -> similar (factor ev er) Ys qs ->
  related (measure_of (ev + er) k) Xs Ys <-> base k ps qs.
Proof.
  intros F A B. pose proof (factor_positive ev er) as P. destruct k as [| | w | w | t]; cbn in F |- *.
  - now apply (meet_similar _ _ _ _ _ P).
  - now apply (meet_similar _ _ _ _ _ P).
  - apply (near_similar _ _ _ _ _ P A B). rewrite whole_value by auto. unfold factor. ring.
  - apply (near_similar _ _ _ _ _ P A B). rewrite whole_value by auto. unfold factor. ring.
  - rewrite !andb_true_iff in F. destruct F as (Fx & Fy & Fz & _).
    apply (along_similar _ _ _ _ _ P A B (Qpower 2 (- scale_of t))); [apply Qpower_0_lt; reflexivity | ..];
      cbn; rewrite whole_value by auto; ring.
Qed.

(** * Touching and crossing exclude each other *)

Lemma cross_not_touch vs us : cross vs us -> touch vs us -> False.
Proof. intros (eps & E & H) (_ & T). destruct (T eps E) as (t & S & N). auto. Qed.
Lemma cross_meet vs us : cross vs us -> meet vs us.
Proof. intros (eps & E & H). apply H. unfold shorter; cbn. repeat split; lra. Qed.

(** * Cells *)

Definition affine (move : triple Z -> triple Z) : Prop :=
  forall d, exists e c, forall v, dot d (move v) = (dot e v + c)%Z.
Lemma posed_late_affine late p : affine (posed_late late p).
Proof.
  intros d. destruct late.
  - exists (Triple (x d * x (fst (x p)) + y d * x (fst (y p)) + z d * x (fst (z p)))
                   (x d * y (fst (x p)) + y d * y (fst (y p)) + z d * y (fst (z p)))
                   (x d * z (fst (x p)) + y d * z (fst (y p)) + z d * z (fst (z p))))%Z.
    exists (x d * snd (x p) + y d * snd (y p) + z d * snd (z p))%Z.
    intros v. unfold posed_late, posed_z, coordinate_z, dot, map3; cbn [x y z]. ring.
  - exists d, 0%Z. intros v. cbn [posed_late]. ring.
Qed.

Lemma spans_moved move ps vs : affine move -> (forall d, spans d ps vs) ->
  forall d, spans d (map move ps) (map move vs).
Proof.
  intros A S d v I. apply in_map_iff in I. destruct I as (u & <- & I). destruct (A d) as (e & c & E).
  destruct (S e u I) as (p & q & P & Q & L). exists (move p), (move q). rewrite !E.
  split; [now apply in_map |]. split; [now apply in_map | lia].
Qed.

(** The boxes hold the corners. *)
Definition in_box (low high v : triple Z) : Prop :=
  (x low <= x v <= x high /\ y low <= y v <= y high /\ z low <= z v <= z high)%Z.
Fixpoint boxed (t : tree) : Prop :=
  match t with
  | Leaf _ => True
  | Node _ low high a b =>
    (forall p v, In p (leaves a ++ leaves b) -> In v (corners p) -> in_box low high v) /\ boxed a /\ boxed b
  end.
Definition boxed_group (g : group) : Prop := match g with Places _ _ => True | Tree t => boxed t end.

Lemma fold_min vs : forall u, let low := fold_left (map_two Z.min) vs u in forall v, In v (u :: vs) ->
  (x low <= x v /\ y low <= y v /\ z low <= z v)%Z.
Proof.
  induction vs as [| w vs IH]; intros u; cbv zeta in *; cbn [fold_left].
  - intros v [<- | []]. lia.
  - pose proof (IH (map_two Z.min u w)) as H. intros v I. pose proof (H _ (or_introl eq_refl)) as L. cbn [map_two x y z] in L.
    destruct I as [<- | [<- | I]]; [lia | lia |]. apply H. now right.
Qed.
Lemma fold_max vs : forall u, let high := fold_left (map_two Z.max) vs u in forall v, In v (u :: vs) ->
  (x v <= x high /\ y v <= y high /\ z v <= z high)%Z.
Proof.
  induction vs as [| w vs IH]; intros u; cbv zeta in *; cbn [fold_left].
  - intros v [<- | []]. lia.
  - pose proof (IH (map_two Z.max u w)) as H. intros v I. pose proof (H _ (or_introl eq_refl)) as L. cbn [map_two x y z] in L.
    destruct I as [<- | [<- | I]]; [lia | lia |]. apply H. now right.
Qed.

Lemma bounds_hold t : boxed t -> forall p v, In p (leaves t) -> In v (corners p) ->
  in_box (fst (bounds t)) (snd (bounds t)) v.
Proof.
  destruct t as [q | n low high a b]; cbn; [| intros (B & _); auto].
  intros _ p v [<- | []] V. destruct (corners q) as [| u us]; [destruct V |]. cbn [fst snd].
  pose proof (fold_min us u v V). pose proof (fold_max us u v V). cbv zeta in *. unfold in_box. lia.
Qed.
Lemma node_boxed n a b : boxed a -> boxed b -> boxed (node n a b) /\ leaves (node n a b) = leaves a ++ leaves b.
Proof.
  intros A B. pose proof (bounds_hold a A) as Ha. pose proof (bounds_hold b B) as Hb. unfold node.
  destruct (bounds a) as (la, ha), (bounds b) as (lb, hb). cbn in *. split; [| auto]. split; [| auto].
  intros p v I V. apply in_app_or in I. unfold in_box in *; cbn.
  destruct I as [I | I]; [specialize (Ha p v I V) | specialize (Hb p v I V)]; lia.
Qed.
Lemma grow_spec levels : forall n ps t rest, grow levels n ps = Some (t, rest) -> boxed t /\ ps = leaves t ++ rest.
Proof.
  induction levels as [| levels IH]; intros n ps t rest; cbn; [discriminate |].
  destruct ps as [| p ps]; [discriminate |]. destruct (n =? 1)%Z.
  - intros H. injection H as <- <-. cbn. auto.
  - destruct (grow levels _ (p :: ps)) as [(a, more) |] eqn:Ea; [| discriminate].
    destruct (grow levels _ more) as [(b, last) |] eqn:Eb; [| discriminate]. intros H. injection H as <- <-.
    apply IH in Ea. apply IH in Eb. destruct Ea as (Ba & Ea), Eb as (Bb & Eb).
    destruct (node_boxed n a b Ba Bb) as (B & L). rewrite L, Ea, Eb, app_assoc. auto.
Qed.

Lemma eight_spans low high v d : in_box low high v ->
  exists p q, In p (eight low high) /\ In q (eight low high) /\ (dot d p <= dot d v <= dot d q)%Z.
Proof.
  intros (X & Y & Z).
  assert (forall c l u h, (l <= u <= h)%Z -> exists a b, (a = l \/ a = h) /\ (b = l \/ b = h) /\ (c * a <= c * u <= c * b)%Z) as Pick.
  { intros c l u h L. destruct (Z.le_ge_cases 0 c); [exists l, h | exists h, l]; repeat split; auto; nia. }
  destruct (Pick (x d) _ _ _ X) as (ax & bx & Ax & Bx & Lx). destruct (Pick (y d) _ _ _ Y) as (ay & by_ & Ay & By & Ly).
  destruct (Pick (z d) _ _ _ Z) as (az & bz & Az & Bz & Lz).
  exists (Triple ax ay az), (Triple bx by_ bz). unfold dot; cbn -[Z.mul]. split; [| split; [| lia]].
  - destruct Ax as [-> | ->], Ay as [-> | ->], Az as [-> | ->]; tauto.
  - destruct Bx as [-> | ->], By as [-> | ->], Bz as [-> | ->]; tauto.
Qed.
Lemma corners_span d ps f : In f ps -> spans d (flat_map corners ps) (corners f).
Proof. intros F v V. exists v, v. split; [apply in_flat_map; eauto |]. split; [apply in_flat_map; eauto | lia]. Qed.
Lemma outer_tree_spans t : forall halvings f, boxed t -> In f (leaves t) -> forall d, spans d (outer_tree halvings t) (corners f).
Proof.
  induction t as [p | n low high a IHa b IHb]; intros halvings f B F d.
  - destruct F as [<- | []]. intros v V. exists v, v. repeat split; auto; lia.
  - cbn [outer_tree]. destruct (4 <? n)%Z; [| now apply corners_span]. destruct B as (Box & Ba & Bb).
    destruct halvings as [| fewer]; intros v V; [apply eight_spans, (Box f); auto |].
    apply in_app_or in F. destruct F as [F | F]; [destruct (IHa fewer f Ba F d v V) as (p & q & P & Q & L)
      | destruct (IHb fewer f Bb F d v V) as (p & q & P & Q & L)]; exists p, q; rewrite !in_app_iff; auto.
Qed.
Lemma outer_spans g f : boxed_group g -> In f (parts g) -> forall d, spans d (outer g) (corners f).
Proof. destruct g as [from ps | t]; cbn -[outer_tree]; intros B F d; [now apply corners_span | now apply outer_tree_spans]. Qed.

Lemma cut_spec {T} (rest : list T) : forall n taken l m, cut n taken rest = (l, m) ->
  forall a, In a taken \/ In a rest <-> In a l \/ In a m.
Proof.
  induction rest as [| b rest IH]; intros n taken l m; cbn; destruct (n <=? 0)%Z; intros E a.
  - injection E as <- <-. cbn. tauto.
  - injection E as <- <-. cbn. tauto.
  - injection E as <- <-. cbn. tauto.
  - rewrite <- (IH _ _ _ _ E a). cbn. tauto.
Qed.

Lemma divide_spec g at_ first second : divide g at_ = Some (first, second) ->
  (forall f, In f (parts g) <-> In f (parts first) \/ In f (parts second)) /\
  (boxed_group g -> boxed_group first /\ boxed_group second).
Proof.
  destruct g as [from ps | [p | n low high a b]], at_ as [at_ |]; cbn; try discriminate.
  - destruct (cut (at_ - from) [] ps) as (l, m) eqn:E.
    destruct l as [| a l]; [discriminate |]. destruct m as [| b m]; [discriminate |].
    intros H. injection H as <- <-. split; [| cbn; auto]. intros f. pose proof (cut_spec _ _ _ _ _ E f) as C. cbn [parts].
    cbn [rev_append]. rewrite rev_append_rev, in_app_iff, <- in_rev. cbn [In] in *. tauto.
  - intros H. injection H as <- <-. cbn. split; [| tauto]. intros f. apply in_app_iff.
Qed.
Lemma only_spec g f : only g = Some f -> parts g = [f].
Proof. destruct g as [from [| p [|]] | [p |]]; cbn; congruence. Qed.

Section Cells.
Variables (m : measure) (move_a move_b : triple Z -> triple Z).
Hypotheses (affine_a : affine move_a) (affine_b : affine move_b).

Definition shape (move : triple Z -> triple Z) (f : part) : list point := map rational (map move (corners f)).
Definition parts_related (f g : part) : Prop := related m (shape move_a f) (shape move_b g).

(** The entry e of the faces f and g is true. *)
Definition about (e : entry) (f g : part) : Prop :=
  key_a e = number_of f /\ key_b e = number_of g /\ parts_related f g /\
  (kind_of e = Crosses -> cross (shape move_a f) (shape move_b g)) /\
  (kind_of e = Touches -> touch (shape move_a f) (shape move_b g)).

(** The pair f, g is decided: not related, or among the entries. *)
Definition decided (found : list entry) (f g : part) : Prop :=
  ~ parts_related f g \/ exists e, In e found /\ about e f g.

Definition part_of (g : group) (fs : list part) : Prop := incl (parts g) fs /\ boxed_group g.

Lemma step_spec c ga gb more entries : step m move_a move_b c ga gb = Some (more, entries) ->
  boxed_group ga -> boxed_group gb ->
  (forall f g, In f (parts ga) -> In g (parts gb) ->
    decided entries f g \/ exists ha hb, In (ha, hb) more /\ In f (parts ha) /\ In g (parts hb)) /\
  (forall e, In e entries -> exists f g, In f (parts ga) /\ In g (parts gb) /\ about e f g) /\
  (forall ha hb, In (ha, hb) more -> part_of ha (parts ga) /\ part_of hb (parts gb)).
Proof.
  destruct c as [[|] at_ | d | i j wa wb why]; cbn.
  - destruct (divide ga at_) as [(first, second) |] eqn:E; [| discriminate]. intros H Ba Bb. injection H as <- <-.
    destruct (divide_spec _ _ _ _ E) as (S & Sb). split; [| split].
    + intros f g F G. right. apply S in F. destruct F; [exists first, gb | exists second, gb]; cbn; auto.
    + intros e [].
    + intros ha hb [K | [K | []]]; injection K as <- <-;
        (split; split; [intros f F; apply S; auto | tauto | apply incl_refl | auto]).
  - destruct (divide gb at_) as [(first, second) |] eqn:E; [| discriminate]. intros H Ba Bb. injection H as <- <-.
    destruct (divide_spec _ _ _ _ E) as (S & Sb). split; [| split].
    + intros f g F G. right. apply S in G. destruct G; [exists ga, first | exists ga, second]; cbn; auto.
    + intros e [].
    + intros ha hb [K | [K | []]]; injection K as <- <-;
        (split; split; [apply incl_refl | auto | intros f F; apply S; auto | tauto]).
  - destruct (separates m d _ _) eqn:E; [| discriminate]. intros H Ba Bb. injection H as <- <-.
    split; [| split; [intros e [] | intros ha hb []]].
    intros f g F G. left. left. apply (separates_spans m d _ _ _ _ E); apply spans_moved; auto; now apply outer_spans.
  - destruct (only ga) as [f |] eqn:Ga; [| discriminate]. destruct (only gb) as [g |] eqn:Gb; [| discriminate].
    rewrite (only_spec _ _ Ga), (only_spec _ _ Gb).
    destruct ((index f =? i)%Z && (index g =? j)%Z && _) eqn:E; [| discriminate].
    rewrite !andb_true_iff in E. destruct E as (_ & R).
    intros H _ _. injection H as <- <-. destruct (reason_sound _ _ _ _ _ _ R) as (M & W).
    assert (about (Entry (number_of f) (number_of g) (kind_of_reason why)) f g) as K.
    { unfold about, parts_related; cbn. split; [auto |]. split; [auto |]. split; [exact M |].
      destruct why; cbn in *; split; intros D; try discriminate; exact W. }
    split; [| split].
    + intros f' g' [<- | []] [<- | []]. left. right. eexists. split; [left; reflexivity | exact K].
    + intros e [<- | []]. exists f, g. cbn. auto.
    + intros ha hb [].
Qed.

Lemma run_spec (fs gs : list part) cs : forall todo found result, run m move_a move_b cs todo found = Done result ->
  (forall ha hb, In (ha, hb) todo -> part_of ha fs /\ part_of hb gs) ->
  (forall e, In e found -> exists f g, In f fs /\ In g gs /\ about e f g) ->
  (forall e, In e result -> exists f g, In f fs /\ In g gs /\ about e f g) /\
  incl found result /\
  (forall ha hb f g, In (ha, hb) todo -> In f (parts ha) -> In g (parts hb) -> decided result f g).
Proof.
  induction cs as [| c cs IH]; intros [| (ga, gb) todo] found result; cbn; intros R T F; try discriminate.
  - injection R as <-. split; auto. split; [apply incl_refl | intros ha hb f g []].
  - destruct (step m move_a move_b c ga gb) as [(more, entries) |] eqn:E; [| discriminate].
    destruct (T ga gb (or_introl eq_refl)) as ((Ta & Ba) & (Tb & Bb)).
    destruct (step_spec _ _ _ _ _ E Ba Bb) as (S1 & S2 & S3).
    destruct (IH _ _ _ R) as (R1 & R2 & R3).
    + intros ha hb I. apply in_app_or in I. destruct I as [I | I]; [| auto].
      destruct (S3 _ _ I) as ((Ia & Ca) & (Ib & Cb)). repeat split; auto; eapply incl_tran; eauto.
    + intros e I. apply in_app_or in I. destruct I as [I | I]; [| auto].
      destruct (S2 _ I) as (f & g & If & Ig & A). exists f, g. auto.
    + split; [auto |]. split; [intros e I; apply R2, in_or_app; auto |].
      intros ha hb f g [K | I] If Ig.
      * injection K as <- <-. destruct (S1 f g If Ig) as [[A | (e & I & A)] | (ka & kb & I & Kf & Kg)].
        -- now left.
        -- right. exists e. split; [apply R2, in_or_app |]; auto.
        -- apply (R3 ka kb); auto. apply in_or_app. auto.
      * apply (R3 ha hb); auto. apply in_or_app. auto.
Qed.

End Cells.

(** * Orders *)

Lemma counts_length {T} (l : list (Z * T)) : forall i ps, counts i l ps = true -> length l = length ps.
Proof.
  induction l as [| (a, b) l IH]; intros i [| p ps] H; cbn in *; try discriminate; auto.
  apply andb_true_iff in H. f_equal. apply (IH (i + 1)%Z). tauto.
Qed.

Lemma in_combine_exists {S T} (l : list S) : forall (m : list T) b, length l = length m -> In b m ->
  exists a, In (a, b) (combine l m).
Proof.
  induction l as [| a l IH]; intros [| c m] b L I; cbn in *; try discriminate; try tauto.
  destruct I as [<- | I]; [exists a; auto |]. destruct (IH m b) as (a' & I'); auto. exists a'. auto.
Qed.

Lemma ordered_spec order ps sorted : ordered order ps = Some sorted -> forall f, In f ps <-> In f sorted.
Proof.
  unfold ordered. destruct ps as [| p ps]; [discriminate |].
  destruct (counts 0 _ _) eqn:C; [| discriminate]. intros H f. injection H as <-.
  apply counts_length in C. set (l := map snd (PlaceSort.sort (numbered 0 order))) in *.
  pose proof (PartSort.Permuted_sort (combine l (p :: ps))) as P.
  split; intros I.
  - destruct (in_combine_exists l (p :: ps) f) as (a & J); [unfold l; now rewrite map_length | auto |].
    apply in_map_iff. exists (a, f). split; auto. apply (Permutation_in _ P J).
  - apply in_map_iff in I. destruct I as ((a, g) & <- & I).
    apply (Permutation_in _ (Permutation_sym P)) in I. apply in_combine_r in I. auto.
Qed.

(** The group holds the parts and no others. *)
Definition all_of (ps : list part) (g : group) : Prop := boxed_group g /\ forall f, In f ps <-> In f (parts g).
Lemma listed_spec order ps g : listed order ps = Some g -> all_of ps g.
Proof.
  unfold listed. destruct (ordered order ps) as [sorted |] eqn:E; [| discriminate]. intros H. injection H as <-.
  split; [exact I | apply (ordered_spec _ _ _ E)].
Qed.
Lemma grown_spec order ps g : grown order ps = Some g -> all_of ps g.
Proof.
  unfold grown. destruct (ordered order ps) as [sorted |] eqn:E; [| discriminate].
  destruct (grow _ _ sorted) as [(t, [|]) |] eqn:G; [| discriminate | discriminate]. intros H. injection H as <-.
  apply grow_spec in G. destruct G as (B & G). rewrite app_nil_r in G. split; [exact B |].
  cbn. rewrite <- G. apply (ordered_spec _ _ _ E).
Qed.
Lemma both_spec a b ga gb : both a b = Some (ga, gb) -> a = Some ga /\ b = Some gb.
Proof. unfold both. destruct a, b; intros H; try discriminate. injection H as <- <-. auto. Qed.

(** * Pairs of faces of the files *)

(** The pair g sums up the entries. *)
Definition sums_up (found : list entry) (gs : list pair_found) : Prop :=
  (forall e, In e found -> exists g, In g gs /\ pair_a g = key_a e /\ pair_b g = key_b e /\
     (kind_of e = Crosses -> crosses g = true) /\ (kind_of e = Meets -> meets_only g = true)) /\
  (forall g, In g gs -> exists e, In e found /\ pair_a g = key_a e /\ pair_b g = key_b e) /\
  (forall g, In g gs -> crosses g = true ->
     exists e, In e found /\ pair_a g = key_a e /\ pair_b g = key_b e /\ kind_of e = Crosses).

Lemma add_entry_spec e found gs : sums_up found gs -> sums_up (e :: found) (add_entry e gs).
Proof.
  intros (A & B & C). unfold add_entry.
  set (c := match kind_of e with Crosses => true | _ => false end).
  set (m := match kind_of e with Meets => true | _ => false end).
  assert (kind_of e = Crosses -> c = true) as Hc by (unfold c; now intros ->).
  assert (kind_of e = Meets -> m = true) as Hm by (unfold m; now intros ->).
  assert (c = true -> kind_of e = Crosses) as Hc' by (unfold c; destruct (kind_of e); congruence).
  assert (sums_up (e :: found) (PairFound (key_a e) (key_b e) c m :: gs)) as New.
  { split; [| split].
    - intros d [<- | I]; [eexists; split; [left; reflexivity | auto] |].
      destruct (A d I) as (g & J & K). exists g. cbn. auto.
    - intros g [<- | I]; [exists e; cbn; auto |]. destruct (B g I) as (d & J & K). exists d. cbn. auto.
    - intros g [<- | I] G; [exists e; cbn in *; auto |]. destruct (C g I G) as (d & J & K). exists d. cbn. auto. }
  destruct gs as [| g rest]; [exact New |].
  destruct ((key_a e =? pair_a g)%Z && (key_b e =? pair_b g)%Z) eqn:E; [| exact New].
  apply andb_true_iff in E. rewrite !Z.eqb_eq in E. destruct E as (Ea & Eb). split; [| split].
  - intros d [<- | I].
    + eexists. split; [left; reflexivity |]. cbn. rewrite !orb_true_iff. intuition.
    + destruct (A d I) as (h & [<- | J] & K).
      * eexists. split; [left; reflexivity |]. cbn. rewrite !orb_true_iff. tauto.
      * exists h. cbn. auto.
  - intros h [<- | I]; [exists e; cbn; auto |]. destruct (B h (or_intror I)) as (d & J & K). exists d. cbn. auto.
  - intros h [<- | I] G; cbn in *.
    + apply orb_true_iff in G. destruct G as [G | G]; [exists e; auto |].
      destruct (C g (or_introl eq_refl) G) as (d & J & K). exists d. auto.
    + destruct (C h (or_intror I) G) as (d & J & K). exists d. auto.
Qed.

Lemma sums_up_incl found found' gs : (forall e, In e found <-> In e found') -> sums_up found gs -> sums_up found' gs.
Proof.
  intros H (A & B & C). split; [| split].
  - intros e I. apply A, H, I.
  - intros g I. destruct (B g I) as (e & J & K). exists e. split; [now apply H | auto].
  - intros g I G. destruct (C g I G) as (e & J & K). exists e. split; [now apply H | auto].
Qed.

Lemma fold_entries l : forall found gs, sums_up found gs ->
  sums_up (rev l ++ found) (fold_left (fun gs e => add_entry e gs) l gs).
Proof.
  induction l as [| e l IH]; cbn; intros found gs H; [auto |].
  rewrite <- app_assoc. apply (IH (e :: found)). now apply add_entry_spec.
Qed.

Lemma pairs_of_spec found : sums_up found (pairs_of found).
Proof.
  unfold pairs_of. assert (sums_up [] []) as E by (split; [| split]; intros ? []).
  apply (fold_entries (rev_append (EntrySort.sort found) [])) in E.
  revert E. apply sums_up_incl. intros e. rewrite app_nil_r, <- in_rev, rev_append_rev, app_nil_r, <- in_rev.
  pose proof (EntrySort.Permuted_sort found) as P. split; intros I.
  - apply (Permutation_in _ (Permutation_sym P) I).
  - apply (Permutation_in _ P I).
Qed.

Lemma ascend_head gs : forall g, ascend (g :: gs) = true -> forall h, In h gs ->
  (pair_a g < pair_a h \/ pair_a g = pair_a h /\ pair_b g < pair_b h)%Z.
Proof.
  induction gs as [| k gs IH]; intros g H h I; [destruct I |].
  change (((pair_a g <? pair_a k)%Z || ((pair_a g =? pair_a k)%Z && (pair_b g <? pair_b k)%Z))
            && ascend (k :: gs) = true) in H.
  rewrite andb_true_iff, orb_true_iff, andb_true_iff, !Z.ltb_lt, Z.eqb_eq in H. destruct H as (H & R).
  destruct I as [<- | I]; [auto |]. pose proof (IH k R h I). lia.
Qed.
Lemma ascend_once gs : ascend gs = true -> forall g h, In g gs -> In h gs ->
  pair_a g = pair_a h -> pair_b g = pair_b h -> g = h.
Proof.
  induction gs as [| k gs IH]; intros A g h G H Ea Eb; [destruct G |].
  pose proof (ascend_head gs k A) as L.
  assert (ascend gs = true) as R by (destruct gs; [auto | cbn in A |- *; apply andb_true_iff in A; tauto]).
  destruct G as [<- | G], H as [<- | H]; auto.
  - apply L in H. lia.
  - apply L in G. lia.
Qed.

(** * From the entries to the claim *)

Lemma all_fulfil_contact c gs : forall ks, all_fulfil c gs ks = true ->
  forall k, In k ks -> exists g, In g gs /\ fulfils c g k = true.
Proof.
  induction gs as [| g gs IH]; intros [| k ks] H j I; cbn in *; try discriminate; try tauto.
  apply andb_true_iff in H. destruct H as (F & H). destruct I as [<- | I]; [exists g; auto |].
  destruct (IH _ H j I) as (h & J & K). exists h. auto.
Qed.
Lemma all_fulfil_pair c gs : forall ks, all_fulfil c gs ks = true ->
  forall g, In g gs -> exists k, In k ks /\ fulfils c g k = true.
Proof.
  induction gs as [| g gs IH]; intros [| k ks] H j I; cbn in *; try discriminate; try tauto.
  apply andb_true_iff in H. destruct H as (F & H). destruct I as [<- | I]; [exists k; auto |].
  destruct (IH _ H j I) as (h & J & K). exists h. auto.
Qed.

(** No pair of faces is there twice. *)
Lemma ascend_nodup (p : pair_found -> bool) gs : ascend gs = true ->
  NoDup (map (fun g => (pair_a g, pair_b g)) (filter p gs)).
Proof.
  induction gs as [| g gs IH]; intros A; cbn; [constructor |].
  pose proof (ascend_head gs g A) as L.
  assert (ascend gs = true) as R by (destruct gs; [auto | cbn in A |- *; apply andb_true_iff in A; tauto]).
  destruct (p g); [| auto]. cbn. constructor; [| auto].
  intros I. apply in_map_iff in I. destruct I as (h & E & I). apply filter_In in I. destruct I as (I & _).
  injection E as Ea Eb. apply L in I. lia.
Qed.
Lemma all_fulfil_keys c gs : forall ks, all_fulfil c gs ks = true ->
  map (fun k => (face_a k, face_b k)) ks = map (fun g => (pair_a g, pair_b g)) gs.
Proof.
  induction gs as [| g gs IH]; intros [| k ks] H; cbn in *; try discriminate; auto.
  apply andb_true_iff in H. destruct H as (F & H). unfold fulfils in F. rewrite !andb_true_iff, !Z.eqb_eq in F.
  destruct F as ((-> & ->) & _). now rewrite (IH _ H).
Qed.

Section Claim.
  Variables (s : scene) (c : claim) (found : list entry).
  Let between (rel : list point -> list point -> Prop) f g := rel (placed (pose_a s) f) (placed (pose_b s) g).
  Definition true_entry e (f g : face) : Prop :=
    key_a e = number_in_file f /\ key_b e = number_in_file g /\ between (base (counted c)) f g /\
    (kind_of e = Crosses -> between cross f g) /\ (kind_of e = Touches -> between touch f g).
  Hypothesis entries_true : forall e, In e found ->
    exists f g, In f (mesh_a s) /\ In g (mesh_b s) /\ true_entry e f g.
  Hypothesis all_decided : all c = true -> forall f g, In f (mesh_a s) -> In g (mesh_b s) ->
    ~ between (base (counted c)) f g \/ exists e, In e found /\ true_entry e f g.
  Hypothesis follows : claim_follows c (pairs_of found) = true.
  Hypothesis one : all c = false -> length (contacts c) = 1%nat.
  Let gs := pairs_of found.

  Lemma pair_related g : In g gs -> some_parts (base (counted c)) s (pair_a g) (pair_b g).
  Proof.
    intros I. destruct (proj1 (proj2 (pairs_of_spec found)) g I) as (e & J & -> & ->).
    destruct (entries_true e J) as (f & h & F & H & -> & -> & M & _). exists f, h. auto.
  Qed.
  Lemma pair_crosses g : In g gs -> crosses g = true -> faces_cross s (pair_a g) (pair_b g).
  Proof.
    intros I C. destruct (proj2 (proj2 (pairs_of_spec found)) g I C) as (e & J & -> & -> & K).
    destruct (entries_true e J) as (f & h & F & H & -> & -> & _ & X & _).
    specialize (X K). exists f, h. auto.
  Qed.

  Lemma base_meet : about_meeting c = true -> base (counted c) = meet.
  Proof. unfold about_meeting. now destruct (counted c). Qed.
  Lemma pair_meets g : about_meeting c = true -> In g gs -> faces_meet s (pair_a g) (pair_b g).
  Proof. intros B I. apply pair_related in I. now rewrite (base_meet B) in I. Qed.

  Lemma ascending : ascend gs = true.
  Proof. unfold claim_follows in follows. rewrite !andb_true_iff in follows. tauto. Qed.

  (** Faces that are related have a pair, and if they meet it tells whether they cross, if all is told. *)
  Lemma met_found i j : all c = true -> some_parts (base (counted c)) s i j ->
    exists g, In g gs /\ pair_a g = i /\ pair_b g = j.
  Proof.
    intros All (f & g & F & G & <- & <- & M). destruct (all_decided All f g F G) as [A | (e & I & T)]; [now elim A |].
    destruct (proj1 (pairs_of_spec found) e I) as (h & J & Ka & Kb & _). destruct T as (Ta & Tb & _).
    exists h. now rewrite Ka, Kb, Ta, Tb.
  Qed.
  Lemma crossing_found i j : about_meeting c = true -> all c = true -> faces_cross s i j ->
    exists g, In g gs /\ pair_a g = i /\ pair_b g = j /\
    (crosses g = true \/ meets_only g = true).
  Proof.
    intros B All (f & g & F & G & <- & <- & X). destruct (all_decided All f g F G) as [A | (e & I & T)].
    - elim A. rewrite (base_meet B). now apply cross_meet.
    - destruct (proj1 (pairs_of_spec found) e I) as (h & J & Ka & Kb & Kc & Km).
      destruct T as (Ta & Tb & _ & _ & Tt). exists h. rewrite Ka, Kb, Ta, Tb.
      split; [auto |]. split; [auto |]. split; [auto |].
      destruct (kind_of e); auto. elim (cross_not_touch _ _ X (Tt eq_refl)).
  Qed.
  Lemma told_not_crossing g : about_meeting c = true -> In g gs -> is_told c g = true -> crosses g = false ->
    ~ faces_cross s (pair_a g) (pair_b g).
  Proof.
    unfold is_told. intros B I T N X. rewrite N in T. cbn in T. apply andb_true_iff in T. destruct T as (All & T).
    destruct (crossing_found _ _ B All X) as (h & J & Ea & Eb & K).
    assert (h = g) as -> by (apply (ascend_once gs ascending); auto).
    destruct K as [K | K]; rewrite K in *; discriminate.
  Qed.

  Theorem claim_holds : holds c s.
  Proof.
    pose proof follows as H. unfold claim_follows in H. fold gs in H. rewrite !andb_true_iff in H.
    destruct H as ((((_ & Untold) & Told) & Fulfil) & Meshes). rewrite orb_true_iff in Untold.
    assert (relation_of_meshes c <> None -> about_meeting c = true) as Meeting_meshes.
    { intros N. destruct Untold as [U | U]; [auto |]. unfold is_untold in U. now destruct (relation_of_meshes c). }
    assert (forall k, In k (contacts c) -> told k <> None -> about_meeting c = true) as Meeting_faces.
    { intros k I N. destruct Untold as [U | U]; [auto |]. unfold is_untold in U. apply andb_true_iff in U.
      destruct U as (_ & U). rewrite forallb_forall in U. specialize (U k I). now destruct (told k). } split; [| split; [| split]].
    - intros k I. destruct (all_fulfil_contact _ _ _ Fulfil k I) as (g & J & F).
      apply filter_In in J. destruct J as (J & Counted). unfold fulfils in F. rewrite !andb_true_iff, !Z.eqb_eq in F.
      destruct F as ((Ea & Eb) & F). unfold contact_holds, is_contact. specialize (Meeting_faces k I).
      rewrite Ea, Eb. split.
      + pose proof (pair_related g J) as R. unfold is_counted, only_crossing in Counted.
        destruct (counted c); cbn in *; auto. now apply pair_crosses.
      + destruct (told k) as [[| |] |]; auto; try discriminate.
        * assert (about_meeting c = true) as B by (apply Meeting_faces; discriminate).
          apply andb_true_iff in F. destruct F as (T & N). split; [now apply pair_meets |].
          apply told_not_crossing; auto. now destruct (crosses g).
        * now apply pair_crosses.
    - rewrite (all_fulfil_keys _ _ _ Fulfil). apply ascend_nodup, ascending.
    - assert (all c = true \/ all c = false) as [All | All] by (destruct (all c); auto); rewrite All; [| auto].
      intros i j. unfold is_contact. intros C.
      assert (exists g, In g (filter (is_counted c) gs) /\ pair_a g = i /\ pair_b g = j) as (g & I & <- & <-).
      { unfold is_counted. destruct (only_crossing c) eqn:O; cbn [negb orb] in *.
        - assert (counted c = CrossingOnly) as K by (unfold only_crossing in O; now destruct (counted c)).
          assert (about_meeting c = true) as B by (unfold about_meeting; now rewrite K).
          rewrite K in C. destruct (crossing_found i j B All C) as (g & I & Ea & Eb & X). exists g. rewrite filter_In.
          repeat split; auto. rewrite forallb_forall in Told. specialize (Told g I). unfold is_told in Told.
          destruct (crosses g); auto. destruct X as [X | X]; [auto |]. rewrite X, andb_false_r in Told. discriminate.
        - assert (counts_as_contact (counted c) = base (counted c)) as K by
            (unfold only_crossing in O; now destruct (counted c)).
          rewrite K in C. destruct (met_found i j All C) as (g & I & Ea & Eb). exists g. rewrite filter_In. auto. }
      destruct (all_fulfil_pair _ _ _ Fulfil g I) as (k & J & F). exists k. split; auto.
      unfold fulfils in F. rewrite !andb_true_iff, !Z.eqb_eq in F. tauto.
    - destruct (relation_of_meshes c) as [r |]; [| auto].
      assert (about_meeting c = true) as B by (apply Meeting_meshes; discriminate).
      pose proof met_found as Found. rewrite (base_meet B) in Found. destruct r; cbn in *.
      + apply andb_true_iff in Meshes. destruct Meshes as (All & E). intros i j M. destruct (Found i j All M) as (g & I & _).
        destruct gs; [destruct I | discriminate].
      + rewrite !andb_true_iff in Meshes. destruct Meshes as ((All & E) & N).
        rewrite forallb_forall in N. split.
        * assert (exists g, In g gs) as (g & I) by (destruct gs as [| g]; [discriminate | exists g; left; auto]).
          exists (pair_a g), (pair_b g). now apply pair_meets.
        * intros i j X. destruct (crossing_found i j B All X) as (g & I & <- & <- & _).
          specialize (N g I). apply andb_true_iff in N. destruct N as (T & N).
          apply (told_not_crossing g B I T); auto. now destruct (crosses g).
      + apply existsb_exists in Meshes. destruct Meshes as (g & I & X). exists (pair_a g), (pair_b g).
        now apply pair_crosses.
  Qed.
End Claim.

(** * The checker *)

Lemma place_spec late ev p m : forall i, Forall2 (fun f part => number_of part = number_in_file f /\
    map (posed_late late p) (corners part) = map (fun v => posed_z p (map3 (whole ev) v)) (vertices f))
  m (posed_early late p (place ev i m)).
Proof.
  unfold posed_early, posed_late.
  induction m as [| f m IH]; intros i; [destruct late; constructor |]. specialize (IH (i + 1)%Z).
  destruct late; (constructor; [| exact IH]); cbn; rewrite ?map_id, ?map_map; auto.
Qed.

Lemma forall2_left {S T} (R : S -> T -> Prop) l m : Forall2 R l m -> forall a, In a l -> exists b, In b m /\ R a b.
Proof. induction 1 as [| a b l m H F IH]; cbn; [tauto |]. intros c [<- | I]; [eauto |]. destruct (IH c I) as (d & J & K). eauto. Qed.
Lemma forall2_right {S T} (R : S -> T -> Prop) l m : Forall2 R l m -> forall b, In b m -> exists a, In a l /\ R a b.
Proof. induction 1 as [| a b l m H F IH]; cbn; [tauto |]. intros c [<- | I]; [eauto |]. destruct (IH c I) as (d & J & K). eauto. Qed.

Lemma posed_similar ev er m p : fits_mesh ev m = true -> fits_pose ev er p = true -> forall f, In f m ->
  similar (factor ev er) (map rational (map (fun v => posed_z (whole_pose ev er p) (map3 (whole ev) v)) (vertices f)))
          (placed p f).
Proof.
  unfold fits_mesh, fits_pose. intros M P f I. rewrite forallb_forall in M. specialize (M f I).
  rewrite forallb_forall in M. rewrite map_map. unfold placed. apply similar_map. intros v J. specialize (M v J).
  cbn -[fits items] in P. cbn [items forallb] in P. rewrite !andb_true_iff in P.
  destruct P as ((X & X') & (Y & Y') & (Z & Z') & _).
  cbn -[coordinate_z coordinate map3 whole]. cbn [map3 x y z whole_pose]. repeat split.
  - apply coordinate_whole; auto. cbn. rewrite !andb_true_iff. tauto.
  - apply coordinate_whole; auto. cbn. rewrite !andb_true_iff. tauto.
  - apply coordinate_whole; auto. cbn. rewrite !andb_true_iff. tauto.
Qed.

(** What is prepared may serve many poses and certificates; the trees may be of any orders. *)
Theorem prepared_holds s c orders trees : let p := prepare (mesh_a s) (mesh_b s) in
  trees = None \/ trees = trees_of p (fst orders) (snd orders) ->
  check_prepared p trees (pose_a s) (pose_b s) c = Accepted -> holds (claimed c) s.
Proof.
  cbv zeta. intros Trees. unfold check_prepared. cbv zeta. set (k := counted (claimed c)). set (late := halving c || negb (all (claimed c))).
  cbn [prepare scale is_scaled is_shaped parts_a parts_b]. set (ev := exponent_of_meshes (mesh_a s) (mesh_b s)).
  set (er := exponent_of_rows ev (pose_a s) (pose_b s) k).
  destruct (fits_mesh ev (mesh_a s) && fits_mesh ev (mesh_b s) && fits_pose ev er (pose_a s) && fits_pose ev er (pose_b s)
            && fits_criterion (ev + er) k) eqn:F; [cbn [negb] | discriminate].
  rewrite !andb_true_iff in F. destruct F as ((((Ma & Mb) & Pa) & Pb) & Fk). set (m := measure_of (ev + er) k) in *.
  destruct (forallb is_shape (mesh_a s) && forallb is_shape (mesh_b s)); [cbn [negb] | discriminate].
  set (wa := whole_pose ev er (pose_a s)). set (wb := whole_pose ev er (pose_b s)).
  set (move_a := posed_late late wa). set (move_b := posed_late late wb).
  set (pa := posed_early late wa _). set (pb := posed_early late wb _).
  pose proof (place_spec late ev wa (mesh_a s) 0) as A. fold pa in A. fold move_a in A.
  pose proof (place_spec late ev wb (mesh_b s) 0) as B. fold pb in B. fold move_b in B.
  pose proof (posed_late_affine late wa) as Affine_a. pose proof (posed_late_affine late wb) as Affine_b.
  fold move_a in Affine_a. fold move_b in Affine_b.
  pose proof (factor_positive ev er) as Positive.
  (* What is proved of parts holds for faces. *)
  assert (forall f g u v e, In f (mesh_a s) -> In g (mesh_b s) ->
            number_of u = number_in_file f /\ map move_a (corners u) = map (fun v => posed_z wa (map3 (whole ev) v)) (vertices f) ->
            number_of v = number_in_file g /\ map move_b (corners v) = map (fun v => posed_z wb (map3 (whole ev) v)) (vertices g) ->
            (about m move_a move_b e u v -> true_entry s (claimed c) e f g) /\
            (~ parts_related m move_a move_b u v -> ~ base k (placed (pose_a s) f) (placed (pose_b s) g))) as Transfer.
  { intros f g u v e If Ig (Nu & Cu) (Nv & Cv).
    pose proof (posed_similar ev er _ _ Ma Pa f If) as Sf. pose proof (posed_similar ev er _ _ Mb Pb g Ig) as Sg.
    fold wa in Sf. fold wb in Sg. rewrite <- Cu in Sf. rewrite <- Cv in Sg.
    fold (shape move_a u) in Sf. fold (shape move_b v) in Sg.
    pose proof (related_similar ev er k _ _ _ _ Fk Sf Sg) as Same. split.
    - intros (Ka & Kb & M & X & T). unfold true_entry. rewrite <- Nu, <- Nv. split; [auto |]. split; [auto |].
      split; [| split].
      + now apply Same.
      + intros K. apply (cross_similar _ _ _ _ _ Positive Sf Sg). auto.
      + intros K. apply (touch_similar _ _ _ _ _ Positive Sf Sg). auto.
    - intros N M. apply N. now apply Same. }
  assert (forall found fs gs, (forall f, In f fs -> In f pa) -> (forall g, In g gs -> In g pb) ->
            (forall e, In e found -> exists f g, In f fs /\ In g gs /\ about m move_a move_b e f g) ->
            forall e, In e found -> exists f g, In f (mesh_a s) /\ In g (mesh_b s) /\ true_entry s (claimed c) e f g) as Entries.
  { intros found fs gs Ifs Igs H e I. destruct (H e I) as (u & v & U & V & K).
    destruct (forall2_right _ _ _ A u (Ifs u U)) as (f & If & Rf).
    destruct (forall2_right _ _ _ B v (Igs v V)) as (g & Ig & Rg).
    exists f, g. split; [auto |]. split; [auto |]. now apply (proj1 (Transfer f g u v e If Ig Rf Rg)). }
  unfold check_parts. destruct (all (claimed c)) eqn:All.
  - destruct (if halving c then _ else _) as [(ga, gb) |] eqn:Sets; [| discriminate].
    assert (all_of pa ga /\ all_of pb gb) as ((Ba & Sa) & (Bb & Sb)).
    { unfold pa, pb, late. destruct (halving c); cbn [orb posed_early].
      - destruct Trees as [-> | ->]; [discriminate |]. apply both_spec in Sets. destruct Sets as (Ga & Gb).
        split; [apply (grown_spec _ _ _ Ga) | apply (grown_spec _ _ _ Gb)].
      - apply both_spec in Sets. destruct Sets as (Ga & Gb).
        split; [apply (listed_spec _ _ _ Ga) | apply (listed_spec _ _ _ Gb)]. }
    destruct (run _ _ _) as [found | rest] eqn:R; [| discriminate]. cbn.
    destruct (claim_follows _ _) eqn:Follows; [| discriminate]. intros _.
    destruct (run_spec m move_a move_b Affine_a Affine_b (parts ga) (parts gb) _ _ _ _ R) as (Sound & _ & Cover).
    + intros ha hb [K | []]. injection K as <- <-. repeat split; auto using incl_refl.
    + intros e [].
    + apply (claim_holds s (claimed c) found); auto.
      * apply (Entries found (parts ga) (parts gb)); auto; intros f If; [now apply Sa | now apply Sb].
      * intros _ f g If Ig.
        destruct (forall2_left _ _ _ A f If) as (u & U & Rf). destruct (forall2_left _ _ _ B g Ig) as (v & V & Rg).
        destruct (Cover _ _ u v (or_introl eq_refl)) as [N | (e & I & K)]; [now apply Sa | now apply Sb | |].
        -- left. apply (proj2 (Transfer f g u v (Entry 0 0 Meets) If Ig Rf Rg) N).
        -- right. exists e. split; [auto |]. apply (proj1 (Transfer f g u v e If Ig Rf Rg) K).
      * congruence.
  - destruct (order_a c); [| discriminate]. destruct (order_b c); [| discriminate].
    destruct (cells c) as [| [| | i j us vs why] [|]] eqn:Cells; try discriminate.
    destruct (contacts (claimed c)) as [| one [|]] eqn:Contacts; try discriminate.
    destruct (find _ pa) as [u |] eqn:U; [| discriminate]. destruct (find _ pb) as [v |] eqn:V; [| discriminate].
    apply find_some in U. apply find_some in V.
    destruct (run _ _ _) as [found | rest] eqn:R; [| discriminate]. unfold conclude.
    destruct (claim_follows _ _) eqn:Follows; [| discriminate]. intros _.
    destruct (run_spec m move_a move_b Affine_a Affine_b [u] [v] _ _ _ _ R) as (Sound & _ & _).
    + intros ha hb [K | []]. injection K as <- <-. repeat split; apply incl_refl.
    + intros e [].
    + apply (claim_holds s (claimed c) found); auto.
      * apply (Entries found [u] [v]); auto; intros f [<- | []]; tauto.
      * congruence.
      * rewrite Contacts. auto.
Qed.

Theorem accepted_holds s c : check s c = Accepted -> holds (claimed c) s.
Proof.
  apply (prepared_holds s c (order_a c, order_b c)). destruct (halving c); auto.
Qed.
